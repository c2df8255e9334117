// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "import/choices.hpp"
#include "import/left_behind.hpp"

namespace mixloop {

/// What a motor is held to, those of the joints that mimic it included; what a robot doesn't say is absent.
struct MotorLimits {
  std::optional<std::pair<double, double>> position;
  std::optional<double> velocity, torque;
};

/// Of each motor. What says nothing (a range of nothing, a velocity or an effort of 0) is listed.
std::vector<MotorLimits> limits_of(const Robot& robot, const Roles& roles, LeftBehind& left);

/// A pose within the limits: 0 where they allow that, else the middle; of the free ones 0.
std::vector<double> home_within(const std::vector<MotorLimits>& limits, std::size_t free);

}  // namespace mixloop
