// SPDX-License-Identifier: MIT
#include "controller/controller_settings.hpp"

#include "controller/controller_keys.hpp"
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

const Keys& controller_keys() {
  static const Keys keys{
      "the controller",
      {{"law", form::word({"pd", "pd_gravity", "pd_feedforward", "computed_torque"}), kRequired},
       {"kp", form::numbers(), kRequired},
       {"kv", form::numbers(), kRequired},
       {"feedforward_at", form::word({"measured", "desired"})},
       {"safety", form::mapping(safety_keys)},
       {"parameters", form::named(form::number())},
       {"scene", form::text()}}};
  return keys;
}

ControllerSettings read_controller_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry = read_mapping(node, controller_keys());
  ControllerSettings settings;
  static constexpr Law kLaws[] = {Law::pd, Law::pd_gravity, Law::pd_feedforward, Law::computed_torque};
  settings.law = kLaws[word_of(*entry.at("law"), words_of(controller_keys(), "law"), "the law")];
  settings.kp = gains(entry, "kp", scene, kPosition);
  settings.kv = gains(entry, "kv", scene, kVelocity);
  if (const NodePtr at = entry.find("feedforward_at"))
    settings.feedforward_at =
        word_of(*at, words_of(controller_keys(), "feedforward_at"), "feedforward_at") == 0
            ? FeedforwardAt::measured
            : FeedforwardAt::desired;
  if (const NodePtr safety = entry.find("safety")) settings.safety = read_safety_settings(safety, scene);
  return settings;
}

}  // namespace mixloop
