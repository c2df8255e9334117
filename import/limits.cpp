// SPDX-License-Identifier: MIT
#include "import/limits.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

/// Narrows a motor's limits to those of a joint that follows it by slope * position + offset.
void narrow(MotorLimits& motor, const Robot::Limits& limits, double slope, double offset) {
  if (limits.lower < limits.upper) {
    const auto [low, high] = std::minmax({(limits.lower - offset) / slope, (limits.upper - offset) / slope});
    const auto known = motor.position.value_or(std::pair{low, high});
    motor.position = {std::max(known.first, low), std::min(known.second, high)};
  }
  if (limits.velocity > 0)
    motor.velocity = std::min(motor.velocity.value_or(limits.velocity / std::abs(slope)),
                              limits.velocity / std::abs(slope));
}

void list_unsaid(const Robot::Joint& joint, LeftBehind& left) {
  if (joint.kind != Robot::Joint::Kind::continuous && joint.limits->lower == joint.limits->upper)
    left.add("limits of position with nothing between them, of the joints", joint.name, joint.place);
  if (joint.limits->velocity == 0)
    left.add("limits of velocity of 0, of the joints", joint.name, joint.place);
  if (joint.limits->effort == 0 && !joint.mimic)
    left.add("limits of effort of 0, of the joints", joint.name, joint.place);
  if (joint.limits->effort != 0 && joint.mimic)
    left.add("limits of effort of joints that mimic others", joint.name, joint.place);
}

/// The middle to a thousandth, where zero isn't between them.
double home_between(const std::pair<double, double>& limits) {
  const auto [low, high] = limits;
  if (low <= 0 && high >= 0) return 0;
  const double middle = (low + high) / 2, rounded = std::round(middle * 1000) / 1000;
  return low < rounded && rounded < high ? rounded : middle;
}

}  // namespace

std::vector<MotorLimits> limits_of(const Robot& robot, const Roles& roles, LeftBehind& left) {
  std::vector<MotorLimits> all(roles.motors.size());
  for (const auto& joint : robot.joints) {
    if (!joint.moves() || !joint.limits) continue;
    list_unsaid(joint, left);
    const Following follows = following(robot, static_cast<int>(&joint - robot.joints.data()));
    const auto motor = std::find(roles.motors.begin(), roles.motors.end(), follows.joint);
    if (motor == roles.motors.end()) {
      left.add("limits of free joints", joint.name, joint.place);
      continue;
    }
    MotorLimits& limits = all[static_cast<std::size_t>(motor - roles.motors.begin())];
    const MotorLimits before = limits;
    Robot::Limits said = *joint.limits;
    if (joint.kind == Robot::Joint::Kind::continuous) said.lower = said.upper = 0;
    narrow(limits, said, follows.slope, follows.offset);
    if (!joint.mimic && said.effort > 0) limits.torque = said.effort;
    if (limits.position && limits.position->first >= limits.position->second) {
      limits.position = before.position;
      left.add("limits of position that contradict those of the joint that is mimicked", joint.name,
               joint.place);
    }
  }
  return all;
}

std::vector<double> home_within(const std::vector<MotorLimits>& limits, std::size_t free) {
  std::vector<double> home;
  for (const MotorLimits& one : limits) home.push_back(one.position ? home_between(*one.position) : 0);
  home.resize(home.size() + free, 0.0);
  return home;
}

}  // namespace mixloop
