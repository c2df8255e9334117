// SPDX-License-Identifier: MIT
#include "loop/recorded_plant.hpp"

namespace mixloop {

RecordedPlant::RecordedPlant(const Experiment& experiment, const Plan& plan)
    : experiment_(experiment),
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
  for (const Fault& fault : faults)
    if (!hardware_.inject(fault)) ++not_taken_;
  const Faults::State* state = plant().faults();
  if (!state) return;
  recorder_.note_changes(plant().tick(), *state);
  faulty_ = state->active;
}

bool RecordedPlant::record_state() {
  return recorder_.state(plant().tick(), plant().psi(), plant().psid(), plant().work());
}

}  // namespace mixloop
