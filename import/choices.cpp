// SPDX-License-Identifier: MIT
#include "import/choices.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostMotors = 64;

bool is_free(const Robot::Joint& joint, const std::string& symbol, const std::vector<std::string>& free) {
  return std::any_of(free.begin(), free.end(),
                     [&](const std::string& name) { return name == joint.name || name == symbol; });
}

void refuse_unknown_free(const Robot& robot, const SceneNames& names, const std::vector<std::string>& free) {
  std::vector<std::string> known;
  for (std::size_t j = 0; j < robot.joints.size(); ++j)
    if (robot.joints[j].moves() && !robot.joints[j].mimic) {
      known.push_back(robot.joints[j].name);
      if (names.joints[j] != robot.joints[j].name) known.push_back(names.joints[j]);
    }
  for (const std::string& name : free)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError("unknown_value", {"--free"},
                       in_quotes(name) + " is no joint that moves by itself" + suggestion(name, known));
}

/// How many joints move a link.
int joints_below(const Robot& robot, int link) {
  int count = 0;
  for (int j = robot.links[static_cast<std::size_t>(link)].joint; j >= 0;) {
    const auto& joint = robot.joints[static_cast<std::size_t>(j)];
    count += joint.moves() ? 1 : 0;
    j = robot.links[static_cast<std::size_t>(joint.parent)].joint;
  }
  return count;
}

}  // namespace

Roles roles_of(const Robot& robot, const SceneNames& names, const std::vector<std::string>& free,
               const std::string& file) {
  refuse_unknown_free(robot, names, free);
  Roles roles;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto& joint = robot.joints[j];
    if (!joint.moves()) continue;
    auto& role = joint.mimic                             ? roles.mimics
                 : is_free(joint, names.joints[j], free) ? roles.free
                                                         : roles.motors;
    role.push_back(static_cast<int>(j));
  }
  if (roles.motors.empty())
    throw InputError("no_motor", {file},
                     roles.free.empty()
                         ? "no joint moves: all are fixed, floating or planar; expected one that is "
                           "revolute, continuous or prismatic"
                         : "each joint that moves by itself is --free; expected one with a motor");
  if (roles.motors.size() + roles.free.size() > kMostMotors)
    throw InputError("too_large", {file},
                     fmt::format("{} joints move by themselves; expected {} at most",
                                 roles.motors.size() + roles.free.size(), kMostMotors));
  return roles;
}

int named_tip(const Robot& robot, const std::string& name) {
  std::vector<std::string> moved;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (joints_below(robot, static_cast<int>(i)) > 0) moved.push_back(robot.links[i].name);
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const Robot::Link& link) { return link.name == name; });
  if (found == robot.links.end() || std::find(moved.begin(), moved.end(), name) == moved.end())
    throw InputError("unknown_value", {"--tip"},
                     in_quotes(name) +
                         (found == robot.links.end() ? " is no link" : " is a link that no joint moves") +
                         suggestion(name, moved));
  return static_cast<int>(found - robot.links.begin());
}

Following following(const Robot& robot, int joint) {
  Following follows{joint};
  const auto mimic = [&]() -> const auto& {
    return robot.joints[static_cast<std::size_t>(follows.joint)].mimic;
  };
  while (mimic()) {
    const Robot::Mimic& next = *mimic();
    follows = {next.joint, follows.slope * next.multiplier, follows.offset + follows.slope * next.offset};
  }
  return follows;
}

std::vector<int> moved_leaves(const Robot& robot) {
  std::vector<bool> is_leaf(robot.links.size(), true);
  for (const auto& joint : robot.joints) is_leaf[static_cast<std::size_t>(joint.parent)] = false;
  std::vector<int> leaves;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (is_leaf[i] && joints_below(robot, static_cast<int>(i)) > 0) leaves.push_back(static_cast<int>(i));
  return leaves;
}

int farthest(const Robot& robot, const std::vector<int>& leaves) {
  return *std::max_element(leaves.begin(), leaves.end(), [&](int one, int other) {
    return joints_below(robot, one) < joints_below(robot, other);
  });
}

}  // namespace mixloop
