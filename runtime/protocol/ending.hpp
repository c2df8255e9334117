// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "mixloop_lcm/fields.hpp"

namespace mixloop {

/// How a plant, controller or planner came to its end, where that is no fault.
enum class Ending : std::uint8_t {
  finished,     ///< the experiment is over
  interrupted,  ///< SIGINT or SIGTERM (in the plant or in this process)
  stopped,      ///< somebody sent _STOP
  broken_off,   ///< the plant ended by a fault; its own message says more
  reset,        ///< the operator asked for tick 0 again, in a new session
};

/// What an ending is called, and what the plant's END gives as its reason (a reset is told by another
/// message).
struct EndingRow {
  Ending ending;
  std::string_view name;
  std::int8_t reason;
};
inline constexpr std::array kEndings = {
    EndingRow{Ending::finished, "finished", sim_control_t::REASON_FINISHED},
    EndingRow{Ending::interrupted, "interrupted", sim_control_t::REASON_INTERRUPTED},
    EndingRow{Ending::stopped, "stopped", sim_control_t::REASON_STOPPED},
    EndingRow{Ending::broken_off, "broken_off", sim_control_t::REASON_FAULT},
    EndingRow{Ending::reset, "reset", sim_control_t::REASON_FAULT}};

constexpr const EndingRow& row_of(Ending ending) { return kEndings[static_cast<std::size_t>(ending)]; }
constexpr std::string_view name(Ending ending) { return row_of(ending).name; }
constexpr std::int8_t end_reason(Ending ending) { return row_of(ending).reason; }

/// The ending that an END's reason means; one that isn't known is a fault.
constexpr Ending ending_of(std::int8_t reason) {
  for (const EndingRow& row : kEndings)
    if (row.reason == reason) return row.ending;
  return Ending::broken_off;
}

}  // namespace mixloop
