// SPDX-License-Identifier: MIT
#include "controller/controller_settings.hpp"

#include "notation/value.hpp"

namespace mixloop {
namespace {

/// A gain is torque per angle (and time) for a rotary motor, force per length for a linear one.
Vector gains(const Mapping& entry, const char* key, const Scene& scene, const Dimension& factor) {
  const auto items = items_of(entry.at(key), "the gains, one a motor");
  if (items.size() != scene.motors.size())
    throw InputError("wrong_size", entry.at(key)->place,
                     std::string(key) + " has " + std::to_string(items.size()) +
                         " values; expected one for each of the " + std::to_string(scene.n()) + " motors");
  Vector values(scene.n());
  for (std::size_t i = 0; i < items.size(); ++i)
    values[static_cast<Eigen::Index>(i)] =
        number_of(*items[i], (scene.motors[i].linear ? kForce / kLength : kMoment) * factor,
                  std::string("a gain of ") + key);
  return values;
}

}  // namespace

ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry(node, "the controller", {"law", "kp", "kv", "feedforward_at", "parameters", "scene"});
  ControllerSettings settings;
  static constexpr Law kLaws[] = {Law::kPd, Law::kPdGravity, Law::kPdFeedforward, Law::kComputedTorque};
  settings.law =
      kLaws[word_of(*entry.at("law"), {"pd", "pd_gravity", "pd_feedforward", "computed_torque"}, "the law")];
  settings.kp = gains(entry, "kp", scene, kPure);
  settings.kv = gains(entry, "kv", scene, kTime);
  if (const NodePtr at = entry.find("feedforward_at"))
    settings.feedforward_at = word_of(*at, {"measured", "desired"}, "feedforward_at") == 0
                                  ? FeedforwardAt::kMeasured
                                  : FeedforwardAt::kDesired;
  return settings;
}

}  // namespace mixloop
