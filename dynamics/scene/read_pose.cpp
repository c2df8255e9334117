// SPDX-License-Identifier: MIT
// Poses and joints about any axis, put together from transforms: what is constant folds away in every
// tracer, so they cost what Denavit and Hartenberg's do.
#include "dynamics/scene/read_pose.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "dynamics/scene/scene_keys.hpp"
#include "dynamics/scene/screws.hpp"
#include "notation/functions/elementary.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// The axis is where Rz(turn) Rx(tilt) puts z, or its opposite.
struct JointAxis {
  double turn = 0, tilt = 0;
  bool backwards = false;
};

JointAxis axis_along(double x, double y, double z) {
  const double size = std::max({std::abs(x), std::abs(y), std::abs(z)});
  x /= size, y /= size, z /= size;
  // -x, -y and -z are x, y and z backwards: right angles alone.
  const bool backwards = (x != 0) + (y != 0) + (z != 0) == 1 && x + y + z < 0;
  if (backwards) x = std::abs(x), y = std::abs(y), z = std::abs(z);
  if (x == 0) return {0, y == 0 && z > 0 ? 0 : mixloop_functions::atan2(-y, z), backwards};
  return {y == 0 ? std::copysign(kQuarter, x) : mixloop_functions::atan2(x, -y),
          mixloop_functions::atan2(std::sqrt(x * x + y * y), z), backwards};
}

JointAxis read_axis(const NodePtr& node, SceneDraft& draft) {
  if (!node) return {};
  const auto [x, y, z] = draft.axis(node, "the axis");
  return axis_along(x, y, z);
}

struct Joint {
  bool slides = false;
  Formula value;
  JointAxis axis;
};

std::optional<Joint> read_joint(const Mapping& entry, SceneDraft& draft) {
  const NodePtr turning = entry.find("revolute"), sliding = entry.find("prismatic"),
                axis = entry.find("axis");
  if (turning && sliding)
    throw InputError("doubly_defined", sliding->place,
                     "a joint is 'revolute' and 'prismatic'; expected one of them");
  if (!turning && !sliding) {
    if (axis)
      throw InputError("missing_key", axis->place,
                       "an axis without a joint; expected 'revolute' or 'prismatic' beside it");
    return std::nullopt;
  }
  const char* key = turning ? "revolute" : "prismatic";
  const NodePtr& node = turning ? turning : sliding;
  Joint joint{
      .slides = !turning,
      .value = draft.formula(*node, turning ? kPure : kLength, fmt::format("'{}'", key), draft.moving),
      .axis = read_axis(axis, draft)};
  const Symbols symbols(draft.scene);
  if (!depends_on(joint.value, [&](int symbol) { return symbol >= symbols.psi0; }))
    throw InputError(
        "varying_number", node->place,
        fmt::format("'{}' names no coordinate; expected a formula that is affine in one, or 'at' "
                    "and 'rpy' alone for what never moves",
                    key));
  return joint;
}

}  // namespace

const Keys& pose_keys() {
  static const Keys keys{"a pose or joint",
                         {{"from", form::text(), kRequired},
                          {"to", form::text(), kRequired},
                          {"at", form::numbers()},
                          {"rpy", form::numbers()},
                          {"revolute", form::number()},
                          {"prismatic", form::number()},
                          {"axis", form::one_of({form::word({"x", "y", "z"}), form::numbers()})}}};
  return keys;
}

bool is_pose(const Mapping& entry) {
  const auto first_in = [&](const Keys& keys) -> const Key* {
    for (const Key& key : keys.all)
      if (!key.required && entry.has(key.name)) return &key;
    return nullptr;
  };
  const Key *pose = first_in(pose_keys()), *numbers = first_in(transform_keys());
  if (pose && numbers)
    throw InputError("doubly_defined", entry.find(pose->name)->place,
                     fmt::format("a transform has '{}', of a pose, beside '{}', one of Denavit and "
                                 "Hartenberg's numbers; expected one or the other",
                                 pose->name, numbers->name));
  return pose != nullptr;
}

std::vector<Scene::Transform> read_pose(const Mapping& entry, SceneDraft& draft) {
  const auto at = draft.vector(entry.find("at"), kLength, "'at'", draft.fixed);
  const auto rpy = draft.vector(entry.find("rpy"), kPure, "'rpy' (roll, pitch, yaw)", draft.fixed);
  const auto joint = read_joint(entry, draft);
  const Place& place = entry.node().place;
  const auto angle = [&](double value) { return constant_formula(value, kPure, place); };
  Screws screws(place);
  screws.move_z(at[2]);
  screws.move_x(at[0]);
  if (!at[1].is_zero()) {  // Ty(y) = Rz(90 deg) Tx(y) Rz(-90 deg)
    screws.turn_z(angle(kQuarter));
    screws.move_x(at[1]);
    screws.turn_z(angle(-kQuarter));
  }
  screws.turn_z(rpy[2]);
  if (!rpy[1].is_zero()) {  // Ry(b) = Rz(90 deg) Rx(b) Rz(-90 deg)
    screws.turn_z(angle(kQuarter));
    screws.turn_x(rpy[1]);
    screws.turn_z(angle(-kQuarter));
  }
  screws.turn_x(rpy[0]);
  if (!joint) return screws.transforms();
  const Formula value = joint->axis.backwards ? opposite_of(joint->value) : joint->value;
  screws.turn_z(angle(joint->axis.turn));
  screws.turn_x(angle(joint->axis.tilt));
  joint->slides ? screws.move_z(value) : screws.turn_z(value);
  screws.turn_x(angle(-joint->axis.tilt));
  screws.turn_z(angle(-joint->axis.turn));
  return screws.transforms();
}

}  // namespace mixloop
