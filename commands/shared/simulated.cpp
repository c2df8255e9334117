// SPDX-License-Identifier: MIT
#include "commands/shared/simulated.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands/shared/progress.hpp"
#include "commands/shared/warnings.hpp"
#include "loop/arrivals.hpp"
#include "loop/arrivals_file.hpp"
#include "loop/kept_files.hpp"
#include "loop/review.hpp"
#include "loop/simulate.hpp"
#include "notation/long_work.hpp"
#include "processes/command_line.hpp"
#include "processes/keep.hpp"
#include "runtime/clock/clock.hpp"

namespace mixloop {

Result simulated(Experiment loaded, const std::string& out, const StopSwitch& stop, bool quiet,
                 const std::string& ages) {
  if (loaded.plant.continuous && !ages.empty())
    throw InputError("out_of_range", {"--ages"},
                     "plant.control is 'continuous', which no run in real time has; expected 'held'");
  const auto arrivals = ages.empty() ? Arrivals() : read_arrivals(ages);
  const auto is_fault = [](const Intervention& i) { return i.cause == nullptr; };
  loaded.plant.faults.injected =
      std::any_of(arrivals.interventions.begin(), arrivals.interventions.end(), is_fault);
  const Plan plan = make_plan(loaded);
  const Experiment experiment = with_integrator_settled(loaded, plan);
  auto warnings = warnings_of(experiment, plan, quiet);
  if (const std::string why = ages.empty() ? "" : foreign_file(result_beside(ages), ages); !why.empty()) {
    warnings.push_back(why);
    if (!quiet) fmt::print(stderr, "warning: {}\n", why);
  }
  if (!out.empty()) begin_run_folder(out);
  RecordedPlant plant(experiment, plan);
  say_complaint(plant.plant().equations().complaint());
  Progress progress(experiment.name, plan.ticks(), experiment.rate_hz);
  const Instant start = now();
  const auto go_on = [&](std::int64_t k) {
    progress.at(k);
    return !stop.turned();
  };
  if (ages.empty())
    simulate(plant, go_on);
  else
    simulate_arrivals(plant, arrivals, go_on);
  const double wall_time = std::chrono::duration<double>(now() - start).count();
  Result result = result_of(experiment, plant.recorder().measures(), "simulate",
                            plant.plant().equations().evaluation(), wall_time);
  const Uninterrupted whole;  // what there is is told and kept
  const auto afterwards =
      stop.turned() ? std::vector<std::string>() : review(experiment, plan, plant.recorder());
  say(afterwards, quiet);
  warnings.insert(warnings.end(), afterwards.begin(), afterwards.end());
  result.warnings = std::move(warnings);
  if (!out.empty()) keep(out, plant, result);
  return result;
}

}  // namespace mixloop
