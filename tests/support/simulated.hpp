// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"
#include "loop/simulate.hpp"

namespace mixloop {

/// What a simulated run measured, from its start to its end.
inline Measures simulated(const Experiment& experiment) {
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  return run.recorder().measures();
}

/// A shipped experiment, interpreted: programs that are used once are not worth compiling.
inline Experiment shipped_experiment(const std::string& name) {
  Experiment experiment = load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / (name + ".yaml"), {});
  experiment.evaluation = Evaluation::interpreter;
  return experiment;
}

}  // namespace mixloop
