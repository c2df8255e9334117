// SPDX-License-Identifier: MIT
#include "loop/result.hpp"

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/sha256.hpp"

namespace mixloop {
namespace {

std::vector<RunFigures::Bound> bounds_of(const Expectation& expect, const Measures& measures) {
  std::vector<RunFigures::Bound> bounds;
  for (const auto& bound : expect.bounds) {
    const double value = bound.value_in(measures);
    bounds.push_back({bound, value, bound.holds(value)});
  }
  return bounds;
}

RunFigures::Integrator integrator_of(const Experiment& experiment) {
  const PlantSettings& plant = experiment.plant;
  RunFigures::Integrator integrator{.name = std::string(facts(plant.integrator).name)};
  if (plant.local_error > 0)
    integrator.local_error = plant.local_error;
  else
    integrator.substeps = plant.substeps;
  if (const auto& choice = experiment.integrator_choice)
    integrator.chosen = {.local_error = choice->asked, .estimate = choice->estimate, .why = choice->why};
  return integrator;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  static constexpr std::string_view kNames[] = {"held",       "missed",      "diverged",
                                                "safe_state", "interrupted", "fault"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Judgement judge(const Experiment& experiment, const Measures& measures) {
  if (measures.interrupted_at) return {Verdict::interrupted, {}, kInterrupted};
  Judgement judgement{.missed = missed(experiment.expect, measures)};
  const bool broken = measures.diverged_at || measures.safe_at;
  if (!judgement.missed.empty())
    judgement.verdict = measures.diverged_at ? Verdict::diverged
                        : measures.safe_at   ? Verdict::safe_state
                                             : Verdict::missed;
  judgement.exit_status = broken ? kRunFault : judgement.missed.empty() ? kHeld : kMissed;
  return judgement;
}

Result failed(Result result, const RunFault& fault) {
  result.judged.verdict = Verdict::fault;
  result.judged.exit_status = kRunFault;
  result.error = {.code = fault.code, .message = fault.what()};
  return result;
}

Result result_of(const Experiment& experiment, const Measures& measures, const std::string& route,
                 Evaluation ran, double wall_time) {
  RunFigures run{.measures = measures,
                 .bounds = bounds_of(experiment.expect, measures),
                 .expects_divergence = experiment.expect.diverges,
                 .wall_time = wall_time,
                 .route = route,
                 .evaluation = std::string(name_of(ran)),
                 .rate = experiment.rate_hz,
                 .scene = experiment.scene->name,
                 .scene_sha256 = sha256_hex(experiment.scene->canonical),
                 .integrator = integrator_of(experiment),
                 .origin = origin_here()};
  if (experiment.plant.random()) run.seed = experiment.plant.seed;
  if (measures.final_psi)
    for (const auto& coordinate : experiment.scene->independent)
      run.position_units.emplace_back(position_unit(coordinate.linear));
  for (const auto& motor : experiment.scene->motors())
    run.torque_units.emplace_back(torque_unit(motor.linear));
  for (std::size_t i = 0; i < experiment.scene->parameters.size(); ++i)
    run.parameters[experiment.scene->parameters[i].name] = experiment.plant_parameters[i];
  return {.experiment = experiment.name, .judged = judge(experiment, measures), .run = std::move(run)};
}

}  // namespace mixloop
