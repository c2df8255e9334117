// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <thread>

#include "commands/commands.hpp"
#include "commands/shared/launched.hpp"
#include "commands/shared/progress.hpp"
#include "loop/cases.hpp"
#include "notation/utf8.hpp"
#include "processes/bus_line.hpp"
#include "processes/keep.hpp"
#include "processes/result_json.hpp"
#include "processes/speed.hpp"
#include "processes/standard_output.hpp"
#include "processes/summary.hpp"
#include "runtime/protocol/real_time_plant.hpp"

namespace mixloop {
namespace {

struct RunLine : CommonOptions {
  Launch launch;
  bool lockstep = false;
  std::string case_name;
};

int run(RunLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  Launch& launch = options.launch;
  options.take_case(launch.experiment, options.case_name);
  launch.sets = options.sets;
  launch.quiet = options.json;
  if (!launch.speed.empty()) {
    const double speed = speed_of(launch.speed);
    if (launch.real_time) require_real_time_speed(speed);
  }
  if (const auto cores = std::thread::hardware_concurrency(); launch.spin && cores < 3) {
    const std::string why = fmt::format(
        "it keeps two cores busy, and there are {}: who waits awake takes the others' time", cores);
    if (launch.real_time)
      throw InputError("out_of_range", {"--spin"},
                       why + ", in real time all of it; expected three cores or more, or no --spin");
    fmt::print(stderr, "mixloop: --spin: {}\n", why);
  }
  Experiment experiment = load_experiment(std::filesystem::path(launch.experiment), options.overrides());
  experiment.evaluation = launch.evaluation;
  experiment.name = name_with_case(experiment.name, options.case_name);
  const auto print = [&](const Result& result) {
    if (options.json) return;
    fmt::print("{}{}", summary(experiment, result), bus_summary(result));
    if (!launch.out.empty()) fmt::print("  kept in {}\n", printable_name(launch.out));
    flush_standard_output();
  };
  bool printed = false;
  const auto at_end = [&](const Result& result) {
    if (!launch.hold || options.json || result.run->measures.interrupted_at) return;
    print(result);
    printed = true;
    fmt::print(
        "\n{}; Ctrl-C ends it. To look on from another terminal, join this network "
        "namespace:\n"
        "  nsenter --preserve-credentials --user --net --target {}\n",
        experiment.has_path() ? "Holding the end point" : "Going on past the end", getpid());
    flush_standard_output();
  };
  Result result = launched(experiment, launch, stop, at_end);
  result.experiment = experiment.name;
  if (!launch.out.empty()) keep_result(launch.out, result);
  if (options.json)
    print_json(json_of(result));
  else if (!printed)
    print(result);
  return result.judged.exit_status;
}

}  // namespace

void add_run_command(CLI::App& command, int& status) {
  auto options = std::make_shared<RunLine>();
  Launch& launch = options->launch;
  add_experiment_option(command, launch.experiment);
  add_common_options(command, *options);
  add_case_option(command, options->case_name);
  add_bus_options(command, launch.bus);
  auto* lockstep =
      command.add_flag("--lockstep", options->lockstep, "plant time waits for every command (the default)");
  command
      .add_flag("--realtime", launch.real_time,
                "plant time keeps pace with the clock: a command acts when it arrives, and has a deadline")
      ->excludes(lockstep);
  command
      .add_option("--speed", launch.speed,
                  "plant seconds a real second, or max: as fast as it goes. In lockstep max, in real time 1")
      ->type_name("X");
  command.add_flag(
      "--spin", launch.spin,
      "plant and controller wait awake: no wake-ups on their way, for two cores and one to spare");
  command.add_flag("--paused", launch.paused, "begin paused, at tick 0; mixloop control goes on from there");
  command.add_flag("--hold", launch.hold, "go on past the end until Ctrl-C, a path's end point held");
  command.add_flag("--truth", launch.truth, "publish TRUTH, which no controller may read");
  command.add_flag("--allow-faults", launch.allow_faults, "obey FAULT messages: mixloop control fault");
  command
      .add_option("--without", launch.without,
                  "do not launch this one: a stranger's is waited for; it is said how ours is started")
      ->check(CLI::IsMember({"plant", "controller", "planner"}))
      ->type_name("PROCESS");
  command.add_option("--order", launch.order, "in which order they are launched")
      ->delimiter(',')
      ->type_name("A,B,C");
  command.add_option("--out", launch.out, "keep result.json, trajectory.csv and the LCM log in this folder")
      ->type_name("DIR");
  add_seconds_option(command, "--patience", launch.patience,
                     "seconds without an answer after which a peer is lost, 10");
  add_seconds_option(command, "--first-wait", launch.first_wait,
                     "seconds to wait for all to be there at the start, 60", 86400);
  add_evaluation_option(command, launch.evaluation);
  command.footer(
      "LCM needs a multicast route; mixloop netns gives a command a network of its own that has one.\n"
      "Examples:\n"
      "  mixloop netns mixloop run experiments/paper.yaml --speed 1 --out "
      "results/paper\n"
      "  mixloop netns mixloop run experiments/paper.yaml --realtime\n"
      "  mixloop run experiments/paper.yaml --without controller     # waits for yours");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
