// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/protocol/plant_runner.hpp"

namespace mixloop {

/// The plant's side of lockstep. For every tick it publishes STATE, waits for the COMMAND that answers it,
/// again and again sending the STATE where none comes, and lets the plant advance.
class LockstepPlant final : public PlantRunner {
 public:
  LockstepPlant(Bus& bus, const StopSwitch& stop, const PlantOptions& options, LockstepSide& plant)
      : PlantRunner(bus, stop, options, plant, 0, std::chrono::milliseconds(10)), plant_(plant) {}

 private:
  Ending run_ticks() override;

  LockstepSide& plant_;
};

}  // namespace mixloop
