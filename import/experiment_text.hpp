// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "import/motion.hpp"

namespace mixloop {

/// The experiment's YAML without its head: the motors from home to the motion's target and back by computed
/// torque, within the robot's limits.
std::string experiment_text(const std::string& scene_file, const Robot& robot, const SceneNames& names,
                            const Roles& roles, const std::vector<double>& home, const Motion& motion,
                            const Tuning& tuning, const std::vector<MotorLimits>& limits);

}  // namespace mixloop
