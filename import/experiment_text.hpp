// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "import/motion.hpp"

namespace mixloop {

/// The experiment's YAML without its head: the motion there and back by computed torque, within the limits.
/// `scene`: its file's name.
std::string experiment_text(const std::string& scene_file, const Robot& robot, const Roles& roles,
                            const Scene& scene, const Motion& motion, const Gains& gains,
                            const std::vector<MotorLimits>& limits);

}  // namespace mixloop
