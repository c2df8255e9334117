// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "loop/recorded_plant.hpp"
#include "loop/truth.hpp"
#include "processes/fault_ear.hpp"
#include "runtime/protocol/plant_side.hpp"

namespace mixloop {

/// An experiment's recorded plant as the bus calls it: what lockstep and real time have in common. What is
/// passed must outlive it.
template <class Side>
class PlantOnBus : public Side {
 public:
  /// `goes_on` is RecordedPlant's.
  PlantOnBus(RecordedPlant& run, std::function<bool(std::int64_t)> goes_on);

  /// From now on it takes the operator's faults from there, where they are allowed.
  void listen(Bus& bus, bool allowed, std::int64_t config, PlantReport& report) {
    ear_.emplace(bus, run_, allowed, config, report);
  }

  bool measure(std::int64_t tick, std::span<double> psi, std::span<double> psid) override;
  void truth(std::int64_t tick, truth_t& message) override;

 protected:
  /// `tick(faults, goes_on)`, and the faults are taken.
  template <class Tick>
  bool live_through(const Tick& tick) {
    const bool sound = tick(ear_ ? ear_->heard() : std::span<const Fault>(), goes_on_);
    if (ear_) ear_->forget();
    return sound;
  }

  RecordedPlant& run_;

 private:
  std::function<bool(std::int64_t)> goes_on_;
  TruthReader truth_;
  std::optional<FaultEar> ear_;
};

class LockstepHardware final : public PlantOnBus<LockstepSide> {
 public:
  using PlantOnBus::PlantOnBus;
  bool advance(std::int64_t tick, std::span<const double> tau) override;
};

class RealTimeHardware final : public PlantOnBus<RealTimeSide> {
 public:
  using PlantOnBus::PlantOnBus;
  void command(const command_t& command, std::int64_t offset) override;
  bool finish_tick(std::int64_t tick) override;
  void make_safe(const char* cause) override { run_.make_safe(cause); }
  bool is_safe() const override { return run_.deadlines().safe().has_value(); }
  DeadlineCounts deadlines() const override;
};

}  // namespace mixloop
