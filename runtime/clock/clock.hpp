// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace mixloop {

using std::chrono::nanoseconds;

/// An instant on CLOCK_MONOTONIC, as time since its epoch.
using Instant = nanoseconds;

/// Now, on CLOCK_MONOTONIC.
Instant now();

/// Sleeps until `due` by an absolute clock_nanosleep; returns early only when a signal was handled.
void sleep_until(Instant due);

/// When the ticks of a plant that runs at `rate_hz * speed` are due, from the instant of its tick 0 on.
/// Lateness up to `slack` is caught up; past it the rest of the schedule moves back by it ("slips").
class Pacer {
 public:
  Pacer(double rate_hz, double speed, nanoseconds slack = std::chrono::milliseconds(10));

  bool paced() const { return ticks_per_second_ > 0; }  ///< false for speed 0: as fast as it goes
  void start(Instant tick_0) { start_ = tick_0; }
  /// From `tick` on, which is due at `at`, goes on with another speed or after a pause.
  void go_on(std::int64_t tick, Instant at, double speed);
  /// The instant of a tick: start + tick / (rate * speed), by one division.
  Instant due(std::int64_t tick) const;
  /// Moves the schedule where `tick` begins at `at`, more than the slack late.
  void began(std::int64_t tick, Instant at);
  double speed() const { return ticks_per_second_ / rate_hz_; }
  nanoseconds slipped() const { return slipped_; }  ///< in total

 private:
  double rate_hz_, ticks_per_second_;
  nanoseconds slack_;
  nanoseconds slipped_{0};
  Instant start_{0};
};

}  // namespace mixloop
