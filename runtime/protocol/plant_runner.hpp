// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/protocol/plant_port.hpp"

namespace mixloop {

/// Runs a plant on the bus from tick 0 to its end, in lockstep or in real time: it owns the clock. After
/// start-up a tick costs no allocation, lock or throw of ours.
class PlantRunner {
 public:
  virtual ~PlantRunner() = default;

  /// Runs to the end and tells the peers that it is over, also where it throws. Ending::broken_off: the
  /// plant's side said so. Throws RunFault `lost_peer`, naming the channel that is silent, or
  /// `config_mismatch`, naming what differs.
  Ending run();

  /// Tells the peers which session comes after a reset.
  void send_reset(std::int64_t next) { port_.send_reset(next); }

  /// Stands after run() has thrown, too; the process counts in it what else it hears.
  PlantReport& report() { return port_.report; }

 protected:
  PlantRunner(Bus& bus, const StopSwitch& stop, const PlantOptions& options, PlantSide& plant,
              std::int32_t state_flags, nanoseconds slack)
      : options_(options), port_(bus, stop, options, plant, state_flags, slack) {}

  bool before_end(std::int64_t tick) const { return options_.hold || tick <= options_.last_tick; }
  /// What `answer` means at a tick that waited for something else: who holds on has finished.
  Ending ending_at(std::int64_t tick, PlantPort::Answer answer) const;

  PlantOptions options_;
  PlantPort port_;

 private:
  virtual Ending run_ticks() = 0;
};

}  // namespace mixloop
