// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/histogram.hpp"
#include "runtime/protocol/sole_sender.hpp"

namespace mixloop {

/// What a plant on the bus can tell afterwards.
struct PlantReport {
  std::int64_t session = 0;
  std::int64_t ticks_done = 0;        ///< commands applied: tick 0 to ticks_done - 1
  std::uint64_t resent = 0;           ///< STATEs sent again after tick 0's command, none having come
  std::uint64_t resent_at_start = 0;  ///< the same while waiting for all to be there
  std::uint64_t failed_sends = 0;
  std::uint64_t joined_late = 0;     ///< commands from a controller that said so
  std::uint64_t refused_faults = 0;  ///< FAULTs that were understood and not obeyed
  std::uint64_t dropped = 0;         ///< datagrams, before anybody looked at them (Bus::dropped)
  Rejects rejects;
  Rival rival;                 ///< a second controller in this session
  Histogram round_trip;        ///< first sending of STATE(k) to arrival of COMMAND(k), k > 0
  Histogram wake_up;           ///< where ticks are paced: from a tick's due time until the plant is awake
  std::uint64_t overruns = 0;  ///< ticks begun so late that plant time slipped
  nanoseconds wall_time{0};    ///< from COMMAND(0) to the last command
  nanoseconds slipped{0};      ///< by which a paced run was late in total
};

}  // namespace mixloop
