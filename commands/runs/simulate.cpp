// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "commands/shared/simulated.hpp"
#include "loop/cases.hpp"
#include "notation/utf8.hpp"
#include "processes/command_line.hpp"
#include "processes/result_json.hpp"
#include "processes/summary.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

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

void add_simulate_command(CLI::App& command, int& status) {
  auto options = std::make_shared<SimulateLine>();
  add_experiment_option(command, options->experiment);
  add_common_options(command, *options);
  command.add_option("--out", options->out, "keep result.json and trajectory.csv in this folder")
      ->type_name("DIR");
  command
      .add_option(
          "--ages", options->ages,
          "the ages.csv that a run in real time kept: its commands arrive as they did then, for the same "
          "trajectory, bit by bit")
      ->type_name("LOG");
  add_case_option(command, options->case_name);
  add_evaluation_option(command, options->evaluation);
  command.footer(
      "Examples:\n"
      "  mixloop simulate experiments/paper.yaml\n"
      "  mixloop simulate experiments/paper.yaml --set parameters.payload='3 kg' --set scene.gravity='[0, 0, "
      "0]'\n"
      "  mixloop simulate experiments/paper_continuous.yaml --json --out results/continuous");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
