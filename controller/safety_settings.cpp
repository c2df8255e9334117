// SPDX-License-Identifier: MIT
#include "controller/safety_settings.hpp"

#include "controller/controller_keys.hpp"
#include "dynamics/scene/coordinate_values.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

/// One positive value a motor; none where the key isn't there.
std::vector<double> limits(const Mapping& entry, const char* key, const Scene& scene,
                           const Quantity& quantity) {
  const NodePtr node = entry.find(key);
  if (!node) return {};
  std::vector<double> values = read_values(node, scene.motors(), quantity, key);
  for (const double value : values)
    if (!(value > 0))
      throw InputError("out_of_range", node->place, std::string(key) + " has a value that is not positive");
  return values;
}

std::vector<std::array<double, 2>> read_range(const NodePtr& node, const Scene& scene) {
  std::vector<std::array<double, 2>> range;
  const auto pairs = items_of(node, "the position range, [least, most] a motor");
  if (pairs.size() != scene.motors().size())
    throw InputError("wrong_size", node->place,
                     "the position range has " + std::to_string(pairs.size()) +
                         " pairs; expected one for each of the " + std::to_string(scene.n_u()) + " motors");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto ends = items_of(pairs[i], "a motor's range");
    if (ends.size() != 2)
      throw InputError("wrong_size", pairs[i]->place, "a motor's range has two ends, [least, most]");
    const Dimension& unit = kPosition.of(scene.motors()[i]);
    range.push_back({number_of(*ends[0], unit, "the least position"), number_of(*ends[1], unit, "the most")});
    if (!(range.back()[0] < range.back()[1]))
      throw InputError("out_of_range", pairs[i]->place, "the range is empty; expected [least, most]");
  }
  return range;
}

}  // namespace

const Keys& safety_keys() {
  static const Keys keys{"the controller's safety",
                         {{"torque_limit", form::numbers()},
                          {"torque_rate_limit", form::numbers()},
                          {"velocity_limit", form::numbers()},
                          {"position_range", form::list(form::numbers())},
                          {"start_tolerance", form::numbers()},
                          {"max_stale", form::whole()},
                          {"safe_command", form::word({"zero_torque", "damp"})}}};
  return keys;
}

SafetySettings read_safety_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry = read_mapping(node, safety_keys());
  SafetySettings settings;
  settings.torque_limit = limits(entry, "torque_limit", scene, kTorque);
  settings.torque_rate_limit = limits(entry, "torque_rate_limit", scene, kTorque / kSeconds);
  settings.velocity_limit = limits(entry, "velocity_limit", scene, kVelocity);
  if (const NodePtr range = entry.find("position_range")) settings.position_range = read_range(range, scene);
  settings.start_tolerance = limits(entry, "start_tolerance", scene, kPosition);
  if (const NodePtr stale = entry.find("max_stale"))
    settings.max_stale = static_cast<int>(whole_number_of(*stale, 0, 1'000'000, "max_stale"));
  if (const NodePtr command = entry.find("safe_command"))
    settings.safe_command = static_cast<SafeCommand>(
        word_of(*command, words_of(safety_keys(), "safe_command"), "the safe command"));
  return settings;
}

}  // namespace mixloop
