// SPDX-License-Identifier: MIT
#include "controller/controller_settings.hpp"

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

/// A gain is torque per `error`.
Vector gains(const Mapping& entry, const char* key, const Scene& scene, const Quantity& error) {
  const auto values = read_values(entry.at(key), scene.motors(), kTorque / error, key);
  return map_of(std::span<const double>(values));
}

}  // namespace

ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry(node, "the controller",
                      {"law", "kp", "kv", "feedforward_at", "safety", "parameters", "scene"});
  ControllerSettings settings;
  static constexpr Law kLaws[] = {Law::pd, Law::pd_gravity, Law::pd_feedforward, Law::computed_torque};
  settings.law =
      kLaws[word_of(*entry.at("law"), {"pd", "pd_gravity", "pd_feedforward", "computed_torque"}, "the law")];
  settings.kp = gains(entry, "kp", scene, kPosition);
  settings.kv = gains(entry, "kv", scene, kVelocity);
  if (const NodePtr at = entry.find("feedforward_at"))
    settings.feedforward_at = word_of(*at, {"measured", "desired"}, "feedforward_at") == 0
                                  ? FeedforwardAt::measured
                                  : FeedforwardAt::desired;
  if (const NodePtr safety = entry.find("safety")) settings.safety = read_safety_settings(safety, scene);
  return settings;
}

}  // namespace mixloop
