// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

#include "commands/attached.hpp"
#include "commands/commands.hpp"
#include "commands/junit.hpp"
#include "commands/launched.hpp"
#include "commands/simulated.hpp"
#include "notation/long_work.hpp"
#include "notation/number_text.hpp"
#include "notation/utf8.hpp"
#include "processes/bus_line.hpp"
#include "processes/result_json.hpp"
#include "processes/standard_output.hpp"
#include "report/progress.hpp"

namespace mixloop {
namespace {

struct TrackLine : CommonOptions {
  std::vector<std::string> experiments;
  bool over_bus = false, attach = false;
  std::string junit;
  BusOptions bus;
  double patience = 10;
  Evaluation evaluation = Evaluation::machine_code;
};

/// As `track` sees it: a divergence that was expected is held.
int exit_status(const Result& result) {
  if (!result.run) return result.judged.exit_status;
  switch (result.judged.verdict) {
    case Verdict::held:
      return kHeld;
    case Verdict::missed:
      return kMissed;
    case Verdict::diverged:
    case Verdict::safe_state:
      return kRunFault;
    case Verdict::interrupted:
    case Verdict::fault:
      break;
  }
  return kInterrupted;
}

Result tracked(const std::string& file, const TrackLine& options, const StopSwitch& stop) {
  Experiment experiment = load_experiment(std::filesystem::path(file), options.overrides());
  experiment.evaluation = options.evaluation;
  const auto patience = nanoseconds(static_cast<std::int64_t>(options.patience * 1e9));
  if (options.attach) return attached(experiment, options.bus, patience, patience, stop);
  if (!options.over_bus) return simulated(experiment, "", stop, true);
  Launch launch;
  launch.experiment = file;
  launch.sets = options.sets;
  launch.bus = options.bus;
  launch.patience = options.patience;
  launch.evaluation = options.evaluation;
  launch.quiet = true;
  return launched(experiment, launch, stop);
}

Result tracked_or_error(const std::string& file, const TrackLine& options, const StopSwitch& stop) {
  const auto error = [&](const std::string& code, const std::string& message, const Place& place,
                         int status) -> Result {
    return {.experiment = printable_name(std::filesystem::path(file).stem().string()),
            .judged = {.verdict = status == kInterrupted ? Verdict::interrupted : Verdict::fault,
                       .exit_status = status},
            .error = {{.code = code, .message = message, .where = to_string(place)}}};
  };
  if (stop.turned()) return error("interrupted", "interrupted before it began", {}, kInterrupted);
  try {
    return tracked(file, options, stop);
  } catch (const InputError& bad) {
    return error(bad.code, bad.message, bad.place, kBadInput);
  } catch (const RunFault& fault) {
    return error(fault.code, fault.what(), {}, kRunFault);
  } catch (const Interrupted& interrupted) {
    return error("interrupted", interrupted.what(), {}, kInterrupted);
  }
}

void print_line(const Result& result) {
  if (const auto& error = result.error; error && !result.run) {
    fmt::print("{:<12} {:<28} {}{}{}\n",
               result.judged.verdict == Verdict::interrupted ? "interrupted" : "error", result.experiment,
               error->where, error->where.empty() ? "" : ": ", error->message);
    return;
  }
  const Measures& measures = result.run->measures;
  std::string text = measures.diverged_at ? fmt::format("diverged at {:.6g} s", *measures.diverged_at)
                     : std::isnan(measures.max_position_error)
                         ? "its position error was never measured"
                         : fmt::format("max {} mm, final {} mm", fixed(measures.max_position_error * 1e3, 7),
                                       fixed(measures.final_position_error * 1e3, 7));
  for (const auto& line : result.judged.missed) text += "; " + line;
  fmt::print("{:<12} {:<28} {}\n", name_of(result.judged.verdict), result.experiment, text);
  flush_standard_output();
}

int run(const TrackLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  std::vector<Result> results;
  int highest = kHeld;
  for (const auto& file : options.experiments) {
    results.push_back(tracked_or_error(file, options, stop));
    highest = std::max(highest, exit_status(results.back()));
    if (!options.json) print_line(results.back());
  }
  if (stop.turned()) highest = kInterrupted;
  if (!options.junit.empty()) write_junit(options.junit, results);
  if (options.json) {
    auto list = nlohmann::json::array();
    for (const Result& result : results) list.push_back(json_of(result));
    print_json({{"results", list}});
  }
  return highest;
}

}  // namespace

void add_track_command(CLI::App& app, int& status) {
  auto options = std::make_shared<TrackLine>();
  auto* command =
      app.add_subcommand("track", "tracking-error tests: runs experiments and holds what each expects");
  command->add_option("experiments", options->experiments, "experiment files")
      ->required()
      ->type_name("EXPERIMENT...");
  add_common_options(*command, *options);
  auto* over_bus =
      command->add_flag("--over-bus", options->over_bus,
                        "by three processes over LCM, as mixloop run does, instead of in this process");
  command->add_flag("--attach", options->attach, "listen to processes that are already running")
      ->excludes(over_bus);
  command->add_option("--junit", options->junit, "write a JUnit report to this file")->type_name("FILE");
  add_seconds_option(*command, "--patience", options->patience,
                     "seconds without a plant after which it is lost, 10");
  add_bus_options(*command, options->bus);
  add_evaluation_option(*command, options->evaluation);
  command->footer(
      "One line each: held, missed (which bound), diverged, or error. An experiment with `expect: {diverges: "
      "true}` is\n"
      "held when it diverges. Exits with the highest status.\n"
      "Example:\n"
      "  mixloop track experiments/*.yaml --junit track.xml");
  command->callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
