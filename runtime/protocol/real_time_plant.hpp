// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/protocol/plant_runner.hpp"

namespace mixloop {

/// Throws InputError for speed 0: real time has no "as fast as it goes".
void require_real_time_speed(double speed);

/// The plant's side of real time: ticks come by an absolute clock, whether or not commands do. It waits only
/// at tick 0, for the first command. From then on a command acts when it arrives, one that isn't there when
/// its tick ends is missed, and too many missed in a row bring the safe state (both are RealTimeSide's to
/// do).
///
/// A plant that wakes up late by less than a quarter of a tick catches up. Later than that, plant time slips
/// by as much, which is counted: no fault of the controller's. Having slept through more than `max_missed`
/// ticks, it goes into its safe state.
class RealTimePlant final : public PlantRunner {
 public:
  /// Throws InputError as require_real_time_speed does.
  RealTimePlant(Bus& bus, const StopSwitch& stop, const PlantOptions& options, RealTimeSide& plant);

 private:
  Ending run_ticks() override;
  PlantPort::Answer live_through(std::int64_t tick);
  void take_command(std::int64_t tick);
  void judge_pace(std::int64_t tick);

  RealTimeSide& plant_;
  std::int64_t newest_ = -1;  ///< the newest command
  int safe_commands_ = 0;     ///< in a row
};

}  // namespace mixloop
