// SPDX-License-Identifier: MIT
#include "stability/survey.hpp"

#include <cmath>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

void narrow(Narrowest& narrowest, const std::optional<double>& value, double time) {
  if (value && (!narrowest.value || *value < *narrowest.value)) narrowest = {value, time};
}

}  // namespace

bool closes_loop(const Experiment& experiment) {
  return experiment.has_path() || experiment.controller.law != Law::torque;
}

Survey survey(const Experiment& experiment, const Plan& plan, int poses) {
  if (!closes_loop(experiment))
    throw InputError(
        "no_path", experiment.path.place,
        "the law torque doesn't look at the state, so it closes no loop, and without a path there is "
        "nothing to stay near: no stability to judge; expected state_feedback, or a path");
  if (!plan.has_path()) poses = 1;
  Linearisation linearisation(experiment);
  Survey survey{.sampling = {1 / experiment.rate_hz, experiment.plant.command_delay},
                .times = {},
                .loops = {},
                .complaint = linearisation.equations().complaint()};
  const auto span = static_cast<double>(plan.ticks() - plan.start_tick());
  for (int i = 0; i < poses; ++i) {
    const auto k = plan.start_tick() + (i == 0 ? 0 : std::llround(span * i / (poses - 1)));
    survey.times.push_back(static_cast<double>(k - plan.start_tick()) / experiment.rate_hz);
    survey.loops.push_back(linearisation.at(plan.at(k), static_cast<double>(k) / experiment.rate_hz));
  }
  return survey;
}

PathLimits path_limits(const Survey& survey) {
  PathLimits limits;
  for (std::size_t i = 0; i < survey.loops.size(); ++i) {
    const Limits here = limits_of(survey.loops[i], survey.sampling);
    if (here.radius > limits.radius) limits.radius = here.radius, limits.time_of_radius = survey.times[i];
    narrow(limits.tick, here.longest_tick, survey.times[i]);
    narrow(limits.delay, here.longest_delay, survey.times[i]);
  }
  return limits;
}

double path_radius(const Survey& survey, const Sampling& sampling) {
  double radius = 0;
  for (const auto& loop : survey.loops)
    radius = std::max(radius, sampled_radius(loop, loop.feedback.gain(), sampling));
  return radius;
}

}  // namespace mixloop
