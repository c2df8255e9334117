// SPDX-License-Identifier: MIT
#include "loop/recorded_plant.hpp"

#include <fmt/format.h>

#include "loop/free_memory.hpp"

namespace mixloop {

namespace {

const Experiment& checked(const Experiment& experiment, const Plan& plan, const RecorderSettings& settings) {
  if (settings.keeps_ticks) require_room(experiment, plan);
  return experiment;
}

double record_bytes(const Experiment& experiment, const Plan& plan) {
  return static_cast<double>(plan.ticks() + 3) * static_cast<double>(Recorder::bytes_a_tick(experiment));
}

/// "the record of ... takes ... GB".
std::string record_of(const Experiment& experiment, const Plan& plan, double bytes) {
  return fmt::format("the record of {} ticks at {:g} Hz takes {:.3g} GB", plan.ticks(), experiment.rate_hz,
                     bytes * 1e-9);
}

[[noreturn]] void refuse_record(const Experiment& experiment, const std::string& why) {
  throw InputError("too_large", experiment.path.place,
                   why + (experiment.has_path() ? "; expected a shorter path, fewer laps or a lower rate"
                                                : "; expected a shorter duration or a lower rate"));
}

}  // namespace

void require_memory(const Experiment& experiment, const Plan& plan) {
  const double bytes = record_bytes(experiment, plan) +
                       static_cast<double>(plan.ticks()) * static_cast<double>(sizeof(Arrival));
  const double free = free_memory();
  if (bytes <= free) return;
  refuse_record(experiment, fmt::format("{} of memory, and {:.3g} GB are free",
                                        record_of(experiment, plan, bytes), free * 1e-9));
}

std::string require_room(const Experiment& experiment, const Plan& plan) {
  const double bytes = record_bytes(experiment, plan);
  const double memory = free_memory();
  if (bytes <= memory) return {};
  const std::string record = record_of(experiment, plan, bytes);
  const double disk = RecordRows::free_disk();
  if (bytes > disk)
    refuse_record(experiment, fmt::format("{}, and {:.3g} GB are free in memory, {:.3g} GB in {}", record,
                                          memory * 1e-9, disk * 1e-9, RecordRows::folder()));
  return fmt::format("{}, more than is free in memory: while it runs it lies in a file in {}", record,
                     RecordRows::folder());
}

RecordedPlant::RecordedPlant(const Experiment& experiment, const Plan& plan, const RecorderSettings& settings)
    : experiment_(checked(experiment, plan, settings)),
      plan_(plan),
      hardware_(make_deadline_plant(experiment, plan)),
      recorder_(experiment, plan, settings),
      psi_(static_cast<Eigen::Index>(plant().measured().size())),
      psid_(psi_.size()) {}

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
  if (const auto watch = plant().closures()) {
    if (std::string why = plant().no_way_on(); !why.empty())
      return recorder_.no_way_on(plant().tick(), std::move(why));
    recorder_.closures(*watch);
  }
  if (const LoopMotion* loops = plant().loops())
    return recorder_.state(plant().tick(), plant().psi(), plant().psid(), plant().work(), *loops,
                           plant().switches());
  return recorder_.state(plant().tick(), plant().psi(), plant().psid(), plant().work());
}

}  // namespace mixloop
