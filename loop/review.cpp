// SPDX-License-Identifier: MIT
#include "loop/review.hpp"

#include <fmt/format.h>

#include "dynamics/procedure/singular_mass.hpp"
#include "dynamics/scene/continuous_angles.hpp"
#include "loop/step_fitness.hpp"

namespace mixloop {
namespace {

/// Of a linearisation that is longer than programs may be: no run needs it.
constexpr const char* kTooLong = "too_large";

IntegratorSettings steps_of(const PlantSettings& plant) {
  return {plant.integrator, plant.substeps, plant.local_error};
}

StepTask task_of(const Experiment& experiment, std::int64_t ticks) {
  return {1 / experiment.rate_hz, ticks, !experiment.plant.actuators.any()};
}

std::optional<StepDoubt> doubt(const Experiment& experiment, const Plan& plan,
                               const std::vector<LinearPlant>& plants) {
  const IntegratorSettings steps = steps_of(experiment.plant);
  const StepTask task = task_of(experiment, plan.ticks());
  const auto worst = misfit(steps, task, plants);
  if (!worst) return std::nullopt;
  return StepDoubt{describe(*worst, steps, task, plants), worst->grows()};
}

/// The programs that such a look takes need no compiling.
PlantProbe probe_of(const Experiment& experiment) {
  return {experiment.scene, experiment.plant_parameters, experiment.plant.actuators, Evaluation::reference};
}

/// The ticks whose states are looked at. A run that diverged ends in states that are its divergence.
std::vector<std::int64_t> ticks_met(const Recorder& record) {
  std::int64_t ticks = record.ticks_recorded();
  if (record.measures().diverged_at) ticks -= ticks / 4;
  auto chosen = ticks_to_look_at(ticks);
  if (ticks > 0 && chosen.back() != ticks - 1) chosen.push_back(ticks - 1);
  return chosen;
}

/// The state that the plant met at tick k, and what its drives were asked for.
PlantPose pose_met(const Recorder& record, std::int64_t k) {
  const auto psi = map_of(record.psi(k)), psid = map_of(record.psid(k));
  PlantPose pose{record.time(k), Vector(psi.size() + psid.size()), map_of(record.commanded(k))};
  pose.x << psi, psid;
  return pose;
}

/// The plant about the states that it met, with the parameters that it had there.
std::vector<LinearPlant> plants_met(PlantProbe& probe, const Recorder& record) {
  std::vector<LinearPlant> plants;
  for (const std::int64_t k : ticks_met(record)) {
    probe.set_parameters(record.conditions(k).parameters);
    const PlantPose pose = pose_met(record, k);
    plants.push_back({pose.t, probe.state_matrix(pose)});
  }
  return plants;
}

/// Of `integrator: auto`: that it added more than was asked for, where the plant was as it had been taken to
/// be.
std::vector<std::string> choice_warnings(const Experiment& experiment, const Recorder& record) {
  const auto& choice = experiment.integrator_choice;
  if (!choice) return {};
  std::vector<PlantPose> poses;
  for (const std::int64_t k : ticks_met(record))
    if (record.conditions(k).since < 0) poses.push_back(pose_met(record, k));
  PlantProbe probe = probe_of(experiment);
  const ChoiceTask task{experiment.rate_hz, choice->asked, !experiment.plant.actuators.any()};
  const LocalError met = largest_local_error(probe, poses, steps_of(experiment.plant), task);
  if (met.error <= choice->asked) return {};
  return {
      fmt::format("integrator: auto took {} with {} step{} a tick for the path, but at {:.4g} s, where the "
                  "run really was, that "
                  "adds {:.1e} a tick and {:.1e} was asked for; expected a smaller plant.local_error, or a "
                  "named integrator",
                  facts(choice->method).name, choice->substeps, choice->substeps == 1 ? "" : "s", met.t,
                  met.error, choice->asked)};
}

/// Of states that the run met, where the plan's gave no cause.
std::vector<std::string> step_warnings(const Experiment& experiment, const Plan& plan,
                                       const Recorder& record) try {
  PlantProbe probe = probe_of(experiment);
  const auto met = doubt(experiment, plan, plants_met(probe, record));
  if (!met || step_doubt(experiment, plan)) return {};
  return {met->text + " (a state that the run met)"};
} catch (const InputError& error) {
  if (error.code != kTooLong) throw;
  return {};  // step_doubt has said so
}

std::vector<std::string> jump_warnings(const Experiment& experiment, const Recorder& record) {
  AngleWatch angles(*experiment.scene, experiment.plant_parameters);
  for (std::int64_t k = 0; angles.needed() && k < record.ticks_recorded(); ++k)
    if (const std::string jumped = angles.look(record.psi(k), record.time(k)); !jumped.empty())
      return {fmt::format("at {:.4g} s {}; from there on the motion is not the mechanism's", record.time(k),
                          jumped)};
  return {};
}

/// Of a run that ended in what is not finite: whether the mass matrix was.
std::vector<std::string> singular_warnings(const Experiment& experiment, const Recorder& record) {
  const std::int64_t last = record.ticks_recorded() - 1;
  if (!record.measures().diverged_at) return {};
  const auto parameters = record.conditions(last).parameters;
  const auto model = make_model<double>(experiment.scene, parameters);
  const auto why = why_mass_is_singular(model, record.psi(last), record.time(last));
  if (!why) return {};
  return {fmt::format("the mass matrix was singular at {:.4g} s: {}", record.time(last), *why)};
}

}  // namespace

std::optional<StepDoubt> step_doubt(const Experiment& experiment, const Plan& plan) try {
  if (!plan.has_path()) return std::nullopt;
  PlantProbe probe = probe_of(experiment);
  const auto poses = poses_on_plan(probe, plan, experiment.rate_hz);
  return doubt(experiment, plan, linearised(probe, poses));
} catch (const InputError& error) {
  if (error.code != kTooLong) throw;
  return StepDoubt{"the integrator's steps were not held against the plant's own motions: " + error.message,
                   false};
}

std::vector<std::string> review(const Experiment& experiment, const Plan& plan, const Recorder& record) {
  if (record.ticks_recorded() == 0) return {};
  // Where coordinates are switched, the declared ones' linearisation and M need not exist.
  if (experiment.plant.partitions) return jump_warnings(experiment, record);
  std::vector<std::string> said = step_warnings(experiment, plan, record);
  if (said.empty()) said = choice_warnings(experiment, record);
  for (auto& more : {jump_warnings(experiment, record), singular_warnings(experiment, record)})
    said.insert(said.end(), more.begin(), more.end());
  return said;
}

}  // namespace mixloop
