// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"

namespace mixloop::stress {

using SharedScene = std::shared_ptr<const Scene>;

SharedScene papers_robot();  ///< scenes/mixed_loop_robot.yaml
/// psi of its angles q2 and q3 at q1 = 0: (B-2) and (B-3) turned round.
inline std::vector<double> papers_motors(double q2, double q3) { return {0, -16 * q2, -16 * q3}; }
SharedScene robot_of_parameters();  ///< the same, every mass, length and ratio a parameter
SharedScene shipped_scene(const std::string& name);
SharedScene scene_of(const std::string& text);
/// tests/oracles/random_mechanism of this seed, which also picks the kind.
SharedScene random_scene(std::uint64_t seed);
/// The same without what exchanges energy: no time, no friction, no loads but springs.
SharedScene conservative_scene(std::uint64_t seed);

/// The parameter's place in the scene's list.
std::size_t parameter_index(const Scene& scene, const std::string& name);

}  // namespace mixloop::stress
