// SPDX-License-Identifier: MIT
#include "processes/plant_on_bus.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

bool saturated(const PlantSettings& settings, std::span<const double> commanded) {
  for (std::size_t i = 0; i < settings.torque_limit.size(); ++i)
    if (std::abs(commanded[i]) > settings.torque_limit[i]) return true;
  return false;
}

}  // namespace

template <class Side>
PlantOnBus<Side>::PlantOnBus(RecordedPlant& run, std::function<bool(std::int64_t)> goes_on)
    : run_(run), goes_on_(std::move(goes_on)), truth_(run.experiment(), run.recorder()) {}

template <class Side>
bool PlantOnBus<Side>::measure(std::int64_t, std::span<double> psi, std::span<double> psid) {
  const auto measured = run_.measure();
  std::copy(measured.psi.begin(), measured.psi.end(), psi.begin());
  std::copy(measured.psid.begin(), measured.psid.end(), psid.begin());
  return measured.stale;
}

template <class Side>
void PlantOnBus<Side>::truth(std::int64_t k, truth_t& message) {
  const Recorder& recorder = run_.recorder();
  const Truth& truth = truth_.at(k);
  const auto copy = [](const auto& from, auto& to) { std::copy(from.begin(), from.end(), std::begin(to)); };
  copy(recorder.psi(k), message.psi);
  copy(recorder.psid(k), message.psid);
  copy(truth.psidd, message.psidd);
  copy(recorder.applied(k), message.tau_applied);
  copy(truth.position, message.position);
  copy(truth.velocity, message.velocity);
  copy(truth.acceleration, message.acceleration);
  message.kinetic_energy = truth.kinetic_energy;
  message.potential_energy = truth.potential_energy;
  message.work = truth.work;
  message.flags = (saturated(run_.experiment().plant, recorder.commanded(k)) ? truth_t::FLAG_SATURATED : 0) |
                  (run_.faulty() ? truth_t::FLAG_FAULT : 0);
}

template class PlantOnBus<LockstepSide>;
template class PlantOnBus<RealTimeSide>;

bool LockstepHardware::advance(std::int64_t, std::span<const double> tau) {
  return live_through(
      [&](auto faults, const auto& goes_on) { return run_.lockstep_tick(tau, faults, goes_on); });
}

void RealTimeHardware::command(const command_t& command, std::int64_t offset) {
  const auto has = [&](std::int32_t flag) { return (command.flags & flag) != 0; };
  const bool blind = has(command_t::FLAG_WITHOUT_REFERENCE);
  run_.command({.offset = offset,
                .command = command.seq,
                .ahead = blind ? Arrival::kBlind : extrapolated_by(command.flags),
                .afterwards = has(command_t::FLAG_AFTERWARDS)},
               command.tau_commanded);
}

bool RealTimeHardware::finish_tick(std::int64_t) {
  return live_through([&](auto faults, const auto& goes_on) { return run_.real_time_tick(faults, goes_on); });
}

DeadlineCounts RealTimeHardware::deadlines() const {
  const DeadlinePlant& plant = run_.deadlines();
  return {.missed = plant.missed(),
          .longest_miss = plant.longest_miss(),
          .success_last_100 = plant.success_last_100()};
}

}  // namespace mixloop
