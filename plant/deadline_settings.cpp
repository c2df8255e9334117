// SPDX-License-Identifier: MIT
#include "plant/deadline_settings.hpp"

#include "notation/value.hpp"
#include "plant/plant_keys.hpp"

namespace mixloop {

std::string_view name_of(SafeState state) {
  static constexpr std::string_view kNames[] = {"hold", "damp", "zero_torque", "brake"};
  return kNames[static_cast<std::size_t>(state)];
}

const Keys& real_time_keys() {
  static const Keys keys{
      "what holds in real time",
      {{"max_missed", form::whole()}, {"safe_state", form::word({"hold", "damp", "zero_torque", "brake"})}}};
  return keys;
}

DeadlineSettings read_deadline_settings(const NodePtr& node) {
  const Mapping entry = read_mapping(node, real_time_keys());
  DeadlineSettings settings;
  if (const NodePtr missed = entry.find("max_missed"))
    settings.max_missed = static_cast<int>(whole_number_of(*missed, 1, 1'000'000, "max_missed"));
  if (const NodePtr state = entry.find("safe_state"))
    settings.safe_state =
        static_cast<SafeState>(word_of(*state, words_of(real_time_keys(), "safe_state"), "the safe state"));
  return settings;
}

}  // namespace mixloop
