// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "import/limits.hpp"

namespace mixloop {

/// From home to a target and back, at rest at each, in joint space.
struct Motion {
  std::vector<double> target;  ///< of the motors, rad or m
  double duration = 2;         ///< of each way, s
  std::vector<std::size_t>
      overloaded;  ///< motors whose limit of torque it doesn't keep with a fifth to spare

  bool overloads(std::size_t motor) const {
    return std::find(overloaded.begin(), overloaded.end(), motor) != overloaded.end();
  }
};

/// A moderate one within the limits: slower and shorter where torque or velocity want it.
Motion moderate_motion(const std::shared_ptr<const Scene>& scene, const Robot& robot, const Roles& roles,
                       const std::vector<MotorLimits>& limits);

/// How the motion is controlled and simulated.
struct Tuning {
  std::vector<double> kp, kv;  ///< a value a motor: critical damping at the same rate for each, the others
                               ///< free, in the lighter of home and target
  int substeps = 1;            ///< of rk4 a tick of 1 ms: what the joints' damping asks for
  bool lags = false;           ///< whether rates change by that damping within a tick, so that what a tick
                               ///< measures is no ground to feed it forward from
};
/// Throws InputError("not_finite"), without a place, where the mass matrix has no finite inverse.
Tuning moderate_tuning(const std::shared_ptr<const Scene>& scene, const Robot& robot, const Roles& roles,
                       const Motion& motion);

/// Which of x, y, z the end effector can be moved along by the motors, at most as many as there are of them.
std::string free_axes(const std::shared_ptr<const Scene>& scene, const Motion& motion);

}  // namespace mixloop
