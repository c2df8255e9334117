// SPDX-License-Identifier: MIT
#include "loop/simulate.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "commands/commands.hpp"
#include "commands/simulated.hpp"
#include "commands/warnings.hpp"
#include "loop/arrivals.hpp"
#include "loop/arrivals_file.hpp"
#include "loop/cases.hpp"
#include "loop/review.hpp"
#include "notation/long_work.hpp"
#include "notation/utf8.hpp"
#include "processes/command_line.hpp"
#include "processes/keep.hpp"
#include "processes/result_json.hpp"
#include "processes/summary.hpp"
#include "report/kept_files.hpp"
#include "report/progress.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/stop_switch.hpp"

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
  require_memory(experiment, plan);
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

namespace {

struct SimulateLine : CommonOptions {
  std::string experiment;
  std::string out;
  std::string ages, case_name;
  Evaluation evaluation = Evaluation::machine_code;
};

int run(SimulateLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  options.take_case(options.experiment, options.case_name);
  Experiment experiment = load_experiment(std::filesystem::path(options.experiment), options.overrides());
  experiment.name = name_with_case(experiment.name, options.case_name);
  experiment.evaluation = options.evaluation;
  const Result result = simulated(experiment, options.out, stop, options.json, options.ages);
  if (options.json)
    print_json(json_of(result));
  else
    fmt::print("{}{}", summary(experiment, result),
               options.out.empty() ? "" : "  kept in " + printable_name(options.out) + "\n");
  return result.judged.exit_status;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& status) {
  auto options = std::make_shared<SimulateLine>();
  auto* command = app.add_subcommand("simulate", "the closed loop in one process, as fast as it goes");
  add_experiment_option(*command, options->experiment);
  add_common_options(*command, *options);
  command->add_option("--out", options->out, "keep result.json and trajectory.csv in this folder")
      ->type_name("DIR");
  command
      ->add_option(
          "--ages", options->ages,
          "the ages.csv that a run in real time kept: its commands arrive as they did then, for the same "
          "trajectory, bit by bit")
      ->type_name("LOG");
  add_case_option(*command, options->case_name);
  add_evaluation_option(*command, options->evaluation);
  command->footer(
      "Examples:\n"
      "  mixloop simulate experiments/paper.yaml\n"
      "  mixloop simulate experiments/paper.yaml --set parameters.payload='3 kg' --set scene.gravity='[0, 0, "
      "0]'\n"
      "  mixloop simulate experiments/paper_continuous.yaml --json --out results/continuous");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
