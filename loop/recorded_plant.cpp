// SPDX-License-Identifier: MIT
#include "loop/recorded_plant.hpp"

#include <fmt/format.h>

#include "loop/free_memory.hpp"

namespace mixloop {

namespace {

const Experiment& checked(const Experiment& experiment, const Plan& plan) {
  require_memory(experiment, plan);
  return experiment;
}

}  // namespace

void require_memory(const Experiment& experiment, const Plan& plan) {
  const double ticks = static_cast<double>(plan.ticks());
  const double bytes =
      ticks * static_cast<double>(Recorder::bytes_a_tick(*experiment.scene) + sizeof(Arrival));
  const double free = free_memory();
  if (bytes <= free) return;
  throw InputError(
      "too_large", experiment.path.place,
      fmt::format("the record of {:.0f} ticks at {:g} Hz takes {:.3g} GB of memory, and {:.3g} GB are free; "
                  "expected a shorter path, fewer laps or a lower rate",
                  ticks, experiment.rate_hz, bytes * 1e-9, free * 1e-9));
}

RecordedPlant::RecordedPlant(const Experiment& experiment, const Plan& plan)
    : experiment_(checked(experiment, plan)),
      plan_(plan),
      hardware_(make_deadline_plant(experiment, plan)),
      recorder_(experiment, plan),
      psi_(map_of(plant().psi())),
      psid_(map_of(plant().psid())) {}

Measurement RecordedPlant::measure() {
  Plant& plant = hardware_.plant();
  if (plant.measures_exactly()) return {plant.psi(), plant.psid(), plant.time()};
  const bool stale = plant.measure(span_of(psi_), span_of(psid_));
  return {span_of(std::as_const(psi_)), span_of(std::as_const(psid_)), plant.time(), stale};
}

void RecordedPlant::make_safe(const char* cause) {
  if (hardware_.safe()) return;
  hardware_.make_safe(cause);
  recorder_.made_safe(plant().tick());
}

void RecordedPlant::take(std::span<const Fault> faults) {
  for (const Fault& fault : faults) hardware_.inject(fault);
  const Faults::State* state = plant().faults();
  if (!state) return;
  recorder_.note_changes(plant().tick(), *state);
  faulty_ = state->active;
}

bool RecordedPlant::record_state() {
  return recorder_.state(plant().tick(), plant().psi(), plant().psid(), plant().work());
}

}  // namespace mixloop
