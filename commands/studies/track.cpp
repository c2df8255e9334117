// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <thread>

#include "commands/commands.hpp"
#include "commands/shared/attached.hpp"
#include "commands/shared/launched.hpp"
#include "commands/shared/progress.hpp"
#include "commands/shared/simulated.hpp"
#include "commands/studies/baseline.hpp"
#include "commands/studies/junit.hpp"
#include "commands/studies/suite.hpp"
#include "commands/studies/swept.hpp"
#include "notation/long_work.hpp"
#include "notation/number_text.hpp"
#include "notation/words.hpp"
#include "processes/bus_line.hpp"
#include "processes/keep.hpp"
#include "processes/result_json.hpp"
#include "processes/standard_output.hpp"

namespace mixloop {
namespace {

struct TrackLine : CommonOptions {
  std::vector<std::string> experiments;
  bool over_bus = false, attach = false;
  std::string junit, out, baseline;
  double worse = 0.05;
  int jobs = 1;
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

/// Where a run keeps its files: a folder of its own in --out; empty where nothing is kept.
std::string folder_of(const SuiteRun& run, const TrackLine& options) {
  if (options.out.empty()) return "";
  std::string name = run.name;
  std::ranges::replace(name, '/', '_');
  return (std::filesystem::path(options.out) / name).string();
}

/// Always in this process: its runs are those of `simulate`.
Result tracked_sweep(const SuiteRun& run, const TrackLine& options, const StopSwitch& stop) {
  if (options.attach)
    throw InputError(
        "out_of_range", {run.file},
        "a sweep runs in this process, and listens to no other; expected track without --attach");
  SweepRequest request = read_sweep(run.file);
  request.called = "mixloop sweep " + shell_word(run.file);
  for (const Override& one : options.overrides()) {
    request.overrides.push_back(one);
    request.called += " --set " + shell_word(one.key + "=" + one.value);
  }
  const Sweep sweep(run.name, request, options.evaluation, false);
  return result_of(
      sweep, swept(sweep, {.out = folder_of(run, options), .threads = options.jobs, .quiet = true}, stop));
}

Result tracked(const SuiteRun& run, const TrackLine& options, const StopSwitch& stop) {
  if (run.unusable) throw InputError(*run.unusable);
  if (run.is_sweep) return tracked_sweep(run, options, stop);
  TrackLine line = options;
  line.sets.insert(line.sets.begin(), run.sets.begin(), run.sets.end());
  Experiment experiment = load_experiment(std::filesystem::path(run.file), line.overrides());
  experiment.name = run.name;
  experiment.evaluation = options.evaluation;
  const std::string out = folder_of(run, options);
  const auto patience = nanoseconds(static_cast<std::int64_t>(options.patience * 1e9));
  if (options.attach) return attached(experiment, options.bus, patience, patience, stop);
  if (!options.over_bus) return simulated(experiment, out, stop, true);
  Launch launch;
  launch.experiment = run.file;
  launch.sets = line.sets;
  launch.out = out;
  launch.bus = options.bus;
  launch.patience = options.patience;
  launch.evaluation = options.evaluation;
  launch.quiet = true;
  Result result = launched(experiment, launch, stop);
  result.experiment = run.name;
  if (!out.empty()) keep_result(out, result);
  return result;
}

Result tracked_or_error(const SuiteRun& run, const TrackLine& options, const StopSwitch& stop) {
  const auto error = [&](const std::string& code, const std::string& message, const Place& place,
                         int status) -> Result {
    return {.experiment = run.name,
            .judged = {.verdict = status == kInterrupted ? Verdict::interrupted : Verdict::fault,
                       .exit_status = status},
            .error = {{.code = code, .message = message, .where = to_string(place)}}};
  };
  if (stop.turned()) return error("interrupted", "interrupted before it began", {}, kInterrupted);
  try {
    return tracked(run, options, stop);
  } catch (const InputError& bad) {
    return error(bad.code, bad.message, bad.place, kBadInput);
  } catch (const RunFault& fault) {
    return error(fault.code, fault.what(), {}, kRunFault);
  } catch (const Interrupted& interrupted) {
    return error("interrupted", interrupted.what(), {}, kInterrupted);
  }
}

/// What there is to say of a motion where no end effector follows a path.
std::string free_motion(const Measures& measures) {
  std::string text;
  if (measures.max_motor_error) {
    text = "motors off by";
    for (const double error : *measures.max_motor_error) text += " " + fixed(error, 7);
    text += ", ";
  }
  text += "final";
  for (const double psi : measures.final_psi.value_or(Vector())) text += " " + fixed(psi, 7);
  if (measures.energy_drift && !std::isnan(*measures.energy_drift))
    text += fmt::format(", energy drift {:.3g}", *measures.energy_drift);
  return text;
}

void print_sweep(const Result& result) {
  const SweepFigures& sweep = *result.sweep;
  std::string text = fmt::format("{} of {} runs", sweep.done, sweep.runs);
  for (std::size_t i = 0; i < std::min<std::size_t>(sweep.figures.size(), 2); ++i)
    text +=
        fmt::format(", {} {:.6g} {}", sweep.figures[i].name, sweep.figures[i].value, sweep.figures[i].unit);
  for (const auto& line : result.judged.missed) text += "; " + line;
  fmt::print("{:<12} {:<28} {}\n", name_of(result.judged.verdict), result.experiment, text);
  flush_standard_output();
}

void print_line(const Result& result) {
  if (const auto& error = result.error; error && !result.run) {
    fmt::print("{:<12} {:<28} {}{}{}\n",
               result.judged.verdict == Verdict::interrupted ? "interrupted" : "error", result.experiment,
               error->where, error->where.empty() ? "" : ": ", error->message);
    return;
  }
  if (result.sweep) return print_sweep(result);
  const Measures& measures = result.run->measures;
  std::string text = measures.diverged_at     ? fmt::format("diverged at {:.6g} s", *measures.diverged_at)
                     : !measures.follows_path ? free_motion(measures)
                     : std::isnan(measures.max_position_error)
                         ? "its position error was never measured"
                         : fmt::format("max {} mm, final {} mm", fixed(measures.max_position_error * 1e3, 7),
                                       fixed(measures.final_position_error * 1e3, 7));
  for (const auto& line : result.judged.missed) text += "; " + line;
  fmt::print("{:<12} {:<28} {}\n", name_of(result.judged.verdict), result.experiment, text);
  flush_standard_output();
}

/// What is worse than last time is missed. Whether anything is.
bool compare(const Baseline& baseline, double part, Result& result) {
  const auto worse = baseline.worse(result, part);
  if (worse.empty()) return false;
  result.judged.missed.insert(result.judged.missed.end(), worse.begin(), worse.end());
  if (result.judged.verdict != Verdict::held) return true;
  result.judged.verdict = Verdict::missed;
  result.judged.exit_status = std::max<int>(result.judged.exit_status, kMissed);
  return true;
}

/// The results of all runs, in their order, `jobs` at a time; `done` with each, in that order, as soon as may
/// be.
std::vector<Result> run_all(const std::vector<SuiteRun>& runs, const TrackLine& options,
                            const StopSwitch& stop, const std::function<void(Result&)>& done) {
  std::vector<std::optional<Result>> results(runs.size());
  std::mutex mutex;
  std::size_t next = 0, told = 0;
  const auto work = [&] {
    for (;;) {
      std::size_t mine;
      {
        const std::lock_guard lock(mutex);
        if (next == runs.size()) return;
        mine = next++;
      }
      Result result = tracked_or_error(runs[mine], options, stop);
      const std::lock_guard lock(mutex);
      results[mine] = std::move(result);
      for (; told < results.size() && results[told]; ++told) done(*results[told]);
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < std::min<int>(options.jobs, static_cast<int>(runs.size())); ++i)
    others.emplace_back([&] {
      const WorkWatch watch([&] { return stop.turned(); });
      work();
    });
  work();
  others.clear();
  std::vector<Result> all;
  for (auto& result : results) all.push_back(std::move(*result));
  return all;
}

int run(const TrackLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  std::optional<Baseline> baseline;
  if (!options.baseline.empty()) baseline.emplace(options.baseline);
  int highest = kHeld;
  bool worse = false;
  const auto results = run_all(suite_of(options.experiments), options, stop, [&](Result& result) {
    if (baseline && compare(*baseline, options.worse, result)) worse = true;
    highest = std::max(highest, exit_status(result));
    if (!options.json) print_line(result);
  });
  if (stop.turned()) highest = kInterrupted;
  if (baseline && !worse && !stop.turned()) baseline->keep(results);
  if (!options.junit.empty()) write_junit(options.junit, results);
  if (options.json) {
    auto list = nlohmann::json::array();
    for (const Result& result : results) list.push_back(json_of(result));
    print_json({{"results", list}});
  }
  return highest;
}

}  // namespace

void add_track_command(CLI::App& command, int& status) {
  auto options = std::make_shared<TrackLine>();
  command.add_option("experiments", options->experiments, "experiment files, and sweeps' (*.sweep.yaml)")
      ->required()
      ->type_name("EXPERIMENT...");
  add_common_options(command, *options);
  auto* over_bus =
      command.add_flag("--over-bus", options->over_bus,
                       "by three processes over LCM, as mixloop run does, instead of in this process");
  auto* attach =
      command.add_flag("--attach", options->attach, "listen to processes that are already running")
          ->excludes(over_bus);
  command.add_option("--junit", options->junit, "write a JUnit report to this file, measures included")
      ->type_name("FILE");
  command.add_option("--out", options->out, "keep each run's files in a folder of its name in this one")
      ->type_name("DIR")
      ->excludes(attach);
  command.add_option("--jobs", options->jobs, "how many run at a time, in this process; 1")
      ->type_name("N")
      ->check(CLI::Range(1, 256))
      ->excludes(over_bus)
      ->excludes(attach);
  command
      .add_option("--baseline", options->baseline,
                  "hold that nothing measured is worse than last time, by more than --worse, and keep it in "
                  "this file "
                  "for the next")
      ->type_name("FILE");
  command.add_option("--worse", options->worse, "the part by which it may be worse, 0.05")
      ->type_name("PART")
      ->check(CLI::Range(0.0, 1000.0));
  add_seconds_option(command, "--patience", options->patience,
                     "seconds without a plant after which it is lost, 10");
  add_bus_options(command, options->bus);
  add_evaluation_option(command, options->evaluation);
  command.footer(
      "One line each: held, missed (which bound), diverged, or error. An experiment with `expect: {diverges: "
      "true}` is\n"
      "held when it diverges; a sweep is one test, its own `expect` held. Exits with the highest status.\n"
      "Example:\n"
      "  mixloop track experiments/*.yaml --jobs 4 --junit track.xml --baseline last.json");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
