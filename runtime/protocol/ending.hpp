// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace mixloop {

/// How a plant, controller or planner came to its end, where that is no fault.
enum class Ending : std::uint8_t {
  finished,     ///< the experiment is over
  interrupted,  ///< SIGINT or SIGTERM (in the plant or in this process)
  stopped,      ///< somebody sent _STOP
  reset,        ///< the operator asked for tick 0 again, in a new session
  broken_off,   ///< the plant ended by a fault; its own message says more
};

constexpr std::string_view name(Ending ending) {
  switch (ending) {
    case Ending::finished:
      return "finished";
    case Ending::interrupted:
      return "interrupted";
    case Ending::stopped:
      return "stopped";
    case Ending::reset:
      return "reset";
    case Ending::broken_off:
      break;
  }
  return "broken_off";
}

}  // namespace mixloop
