// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "plant/faults.hpp"

namespace mixloop {

/// When a command arrived, and how the controller came to it.
struct Arrival {
  static constexpr std::int64_t kBlind = -1;

  std::int64_t tick = 0;     ///< in which it arrived
  std::int64_t offset = 0;   ///< ns of plant time after the tick's start
  std::int64_t command = 0;  ///< the tick that it answers
  std::int64_t ahead = 0;    ///< ticks by which its reference was extrapolated; kBlind: safe, for want of one
  bool afterwards = false;   ///< a safe one, after one that came to be like that and was lost
  bool operator==(const Arrival&) const = default;
};

/// Somebody's doing that no command tells of.
struct Intervention {
  std::int64_t tick = 0;        ///< from which it acts
  const char* cause = nullptr;  ///< of a safe state that it brought; a literal, or interned. Null: a fault
  Fault fault = {};
  bool operator==(const Intervention&) const = default;
};

/// All in which a run in real time differs from another one, each in the order of time.
struct Arrivals {
  std::vector<Arrival> commands;
  std::vector<Intervention> interventions;
  bool operator==(const Arrivals&) const = default;
};

}  // namespace mixloop
