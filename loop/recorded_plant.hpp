// SPDX-License-Identifier: MIT
#pragma once

#include "controller/measurement.hpp"
#include "loop/recorder.hpp"

namespace mixloop {

/// Throws InputError("too_large") where the record of a run takes more memory than is free here: before it is
/// taken. In real time it must lie there.
void require_memory(const Experiment& experiment, const Plan& plan);
/// The same where there is no room on disk either; else what is to be said of where it will lie (RecordRows),
/// empty where that is memory.
std::string require_room(const Experiment& experiment, const Plan& plan);

/// A plant and the record of its run. It alone knows the order of things in a tick, in lockstep and in real
/// time, so that whoever drives it, in this process or over the bus, gets the same bytes:
///
///   measure()          what the sensors say at the tick in hand
///   lockstep_tick()    faults, the command, its record; on to the next tick, whose state is recorded
///   real_time_tick()   faults, on to the next tick by the commands that arrived; record of both
///
/// A tick is false where the run has diverged: nothing of the next tick may be told. `goes_on(k)` is asked
/// once tick k is recorded. Nothing allocates after construction.
class RecordedPlant {
 public:
  /// What is passed must outlive it. Throws what require_room throws, where ticks are kept.
  RecordedPlant(const Experiment& experiment, const Plan& plan, const RecorderSettings& settings = {});

  const Experiment& experiment() const { return experiment_; }
  const Plan& plan() const { return plan_; }
  const Plant& plant() const { return hardware_.plant(); }
  const DeadlinePlant& deadlines() const { return hardware_; }  ///< what there is of them in real time
  Recorder& recorder() { return recorder_; }
  const Recorder& recorder() const { return recorder_; }
  bool faulty() const { return faulty_; }  ///< something was wrong at the tick last recorded

  /// Records the state at tick 0. False: it is too far from the path.
  bool begin() { return record_state(); }

  /// What a controller gets to see at the tick in hand; valid until the next one.
  Measurement measure();

  /// `faults` act from the tick in hand on, its sensors being read.
  template <class GoesOn>
  bool lockstep_tick(std::span<const double> tau, std::span<const Fault> faults, const GoesOn& goes_on) {
    return lockstep_tick(tau, faults, goes_on, [](Plant& plant) { plant.advance(); });
  }
  /// `advance(plant)` goes on to the next tick.
  template <class GoesOn, class Advance>
  bool lockstep_tick(std::span<const double> tau, std::span<const Fault> faults, const GoesOn& goes_on,
                     const Advance& advance);

  /// A command arrives in the tick in hand, in real time.
  void command(const Arrival& arrival, std::span<const double> tau) { hardware_.command(arrival, tau); }
  /// Brings the safe state, in real time. `cause` must outlive this.
  void make_safe(const char* cause);

  template <class GoesOn>
  bool real_time_tick(std::span<const Fault> faults, const GoesOn& goes_on);

 private:
  void take(std::span<const Fault> faults);
  bool record_state();

  const Experiment& experiment_;
  const Plan& plan_;
  DeadlinePlant hardware_;
  Recorder recorder_;
  Vector psi_, psid_;  ///< measured, where that isn't exact
  bool faulty_ = false;
};

template <class GoesOn, class Advance>
bool RecordedPlant::lockstep_tick(std::span<const double> tau, std::span<const Fault> faults,
                                  const GoesOn& goes_on, const Advance& advance) {
  Plant& plant = hardware_.plant();
  const std::int64_t k = plant.tick();
  take(faults);
  plant.command(tau);
  if (!recorder_.command(k, tau, plant.applied())) return false;
  if (!goes_on(k)) return true;
  advance(plant);
  return record_state();
}

template <class GoesOn>
bool RecordedPlant::real_time_tick(std::span<const Fault> faults, const GoesOn& goes_on) {
  const std::int64_t k = plant().tick();
  const bool was_safe = hardware_.safe().has_value();
  take(faults);
  hardware_.finish_tick();
  if (!was_safe && hardware_.safe()) recorder_.made_safe(k + 1);
  if (!recorder_.command(k, hardware_.commanded(), plant().applied())) return false;
  return !goes_on(k) || record_state();
}

}  // namespace mixloop
