// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/protocol/plant_port.hpp"

namespace mixloop {

/// The plant's side of lockstep: it owns the clock. For every tick it publishes STATE, waits for the COMMAND
/// that answers it, again and again sending the STATE where none comes, and lets the plant advance.
///
/// After start-up a tick costs no allocation, lock or throw of ours.
class LockstepPlant {
 public:
  LockstepPlant(Bus& bus, const StopSwitch& stop, const PlantOptions& options, PlantSide plant);

  /// Runs to the end and tells the peers that it is over, also where it throws.
  /// Ending::broken_off: `advance` said so. Throws RunFault `lost_peer`, naming the channel that is silent,
  /// or `config_mismatch`, naming what differs.
  Ending run();

  /// Tells the peers which session comes after a reset.
  void send_reset(std::int64_t next) { port_.send_reset(next); }

  const PlantReport& report() const { return port_.report; }  ///< true after run() has thrown, too
  PlantReport& report() { return port_.report; }              ///< to count what else the process hears

 private:
  Ending run_ticks();
  bool before_end(std::int64_t tick) const { return hold_ || tick <= last_tick_; }

  PlantSide plant_;
  std::int64_t last_tick_;
  bool hold_;
  PlantPort port_;
};

}  // namespace mixloop
