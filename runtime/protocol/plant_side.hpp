// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "runtime/bus/wire.hpp"

namespace mixloop {

/// The simulated hardware as a plant's runner calls it. No function may allocate, lock or throw.
class PlantSide {
 public:
  virtual ~PlantSide() = default;

  /// The sensors at the start of a tick; true: a reading is stale.
  virtual bool measure(std::int64_t tick, std::span<double> psi, std::span<double> psid) = 0;
  /// What was true at the start of a tick, called once it is over and only where truth is asked for.
  virtual void truth(std::int64_t tick, truth_t& message) = 0;
};

class LockstepSide : public PlantSide {
 public:
  /// Takes the tick's command and goes to the start of the next one (at the last tick: records the command).
  /// False: the run is over (divergence), nothing of the next tick may be published.
  virtual bool advance(std::int64_t tick, std::span<const double> tau) = 0;
};

/// What a plant counts only where commands have a deadline.
struct DeadlineCounts {
  std::int64_t missed = 0, longest_miss = 0;
  double success_last_100 = 1;
};

class RealTimeSide : public PlantSide {
 public:
  /// A command arrives `offset` ns of plant time after the start of the tick in hand.
  virtual void command(const command_t& command, std::int64_t offset) = 0;
  /// Goes on to the start of the next tick. False: as for advance.
  virtual bool finish_tick(std::int64_t tick) = 0;
  /// Brings the safe state; `cause` is a literal.
  virtual void make_safe(const char* cause) = 0;
  virtual bool is_safe() const = 0;
  virtual DeadlineCounts deadlines() const = 0;
};

}  // namespace mixloop
