// SPDX-License-Identifier: MIT
#include "commands/studies/swept.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "commands/studies/modules.hpp"
#include "commands/studies/sweep_progress.hpp"
#include "loop/output_file.hpp"
#include "loop/result.hpp"
#include "notation/long_work.hpp"
#include "notation/utf8.hpp"
#include "processes/called_as.hpp"
#include "processes/result_json.hpp"
#include "sweep/go_through.hpp"

namespace mixloop {
namespace {

/// A folder that is gone with it.
class PassingFolder {
 public:
  PassingFolder() : path_((std::filesystem::temp_directory_path() / "mixloop-sweep-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw RunFault("cannot_write", "no folder can be made in " + path_ + "; expected room there, or --out");
  }
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// "99.9 % of the runs: max_position_error at most 0.014 m".
std::string text_of(const Sweep::Bound& bound) {
  std::string text;
  for (const auto& one : bound.expected.bounds) {
    text += (text.empty() ? "" : ", ") + one.name + (one.motor ? fmt::format("[{}]", *one.motor) : "");
    text += one.least > 0 ? fmt::format(" {:.6g} to {:.6g}", one.least, one.most)
                          : fmt::format(" at most {:.6g}", one.most);
    text += (one.unit.empty() ? "" : " ") + one.unit;
  }
  if (bound.expected.diverges) text += "diverge";
  if (bound.expected.safe_state) text += text.empty() ? "safe state" : ", safe state";
  return fmt::format("{:.9g} % of the runs: {}", bound.share * 100,
                     text.empty() ? "end as they should" : text);
}

double part_held(const BoundStatistics& bound, const Statistics& statistics) {
  return statistics.runs > 0 ? static_cast<double>(bound.held) / static_cast<double>(statistics.runs) : NAN;
}

std::vector<std::string> missed(const Sweep& sweep, const Statistics& statistics) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < statistics.bounds.size(); ++i) {
    const BoundStatistics& bound = statistics.bounds[i];
    if (bound.is_held) continue;
    std::string line =
        fmt::format("{}: only {:.6g} %", text_of(sweep.bounds()[i]), 100 * part_held(bound, statistics));
    if (bound.worst) {
      for (const auto& why : bound.missed) line += "; run " + std::to_string(*bound.worst) + ": " + why;
      line += "; " + as_called(sweep.command(*bound.worst));
    }
    lines.push_back(line);
  }
  return lines;
}

void write_tables(const std::filesystem::path& folder, const Sweep& sweep, const KeptRuns& kept) {
  const Uninterrupted whole;
  const EachRun each = [&](const auto& told) { kept.each(told); };
  write_csv(folder / "table.csv", sweep, each);
  if (const WriteColumns hdf5 = hdf5_here()) write_columns(folder / "table.h5", sweep, each, hdf5);
}

void require_all(const Sweep& sweep, const SweepFolder& folder, const KeptRuns& kept) {
  const auto pending = without(sweep.runs(), kept.done());
  if (pending.empty()) return;
  std::int64_t missing = 0;
  for (const Runs& runs : pending) missing += runs.count;
  throw InputError(
      "missing_runs", {folder.path().string()},
      fmt::format("{} of {} runs are not there, the first is run {}; expected all shards to have "
                  "ended: the command of one that hasn't goes on with it, and the same command "
                  "without --shard and --merge does all that is missing",
                  missing, sweep.runs(), pending.front().first));
}

}  // namespace

Swept swept(const Sweep& sweep, const SweepOptions& options, const StopSwitch& stop) {
  std::optional<PassingFolder> passing;
  if (options.out.empty()) passing.emplace();
  const SweepFolder folder(passing ? passing->path() : options.out, sweep, options.part);
  const auto began = std::chrono::steady_clock::now();
  if (!options.merges) {
    ShownSweep shown(sweep.name(), options.quiet);
    go_through(sweep, folder, options.part,
               {.engine = LaneEngine(options.device),
                .threads = options.threads,
                .peers = options.peers,
                .patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * options.patience)),
                .goes_on = [&] { return !stop.turned(); },
                .told = [&](const SweepProgress& progress) { shown.at(progress); },
                .said = [&](const std::string& text) { shown.say(text); }});
  }
  const KeptRuns kept(folder.journals(), sweep.sha256(), sweep.telling().columns.size());
  if (options.merges) require_all(sweep, folder, kept);
  Swept result{.runs = sweep.runs(), .interrupted = stop.turned()};
  const Uninterrupted whole;  // what there is is told
  result.statistics = statistics_of(sweep, [&](const auto& told) { kept.each(told); });
  if (result.is_whole() && options.part.is_whole()) {
    result.interrupted = false;
    if (!passing) write_tables(folder.path(), sweep, kept);
    result.missed = missed(sweep, result.statistics);
  }
  result.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  result.exit_status = result.interrupted ? kInterrupted : result.missed.empty() ? kHeld : kMissed;
  if (!passing && result.is_whole() && options.part.is_whole())
    write_file(folder.path() / "summary.json", json_text(json_of(sweep, result, options), 2) + "\n");
  return result;
}

Result result_of(const Sweep& sweep, const Swept& swept) {
  SweepFigures figures{.runs = swept.runs, .done = swept.statistics.runs, .wall_time = swept.wall_time};
  for (std::size_t i = 0; i < swept.statistics.columns.size(); ++i) {
    const ColumnStatistics& column = swept.statistics.columns[i];
    const auto& told = sweep.telling().columns[i];
    if (column.measured == 0) continue;
    figures.figures.push_back({told.name + " max", told.unit, column.most});
    figures.figures.push_back({told.name + " p99.9", told.unit, column.quantiles.back()});
    figures.figures.push_back({told.name + " mean", told.unit, column.mean});
  }
  return {.experiment = sweep.name(),
          .judged = {.verdict = swept.interrupted      ? Verdict::interrupted
                                : swept.missed.empty() ? Verdict::held
                                                       : Verdict::missed,
                     .missed = swept.missed,
                     .exit_status = swept.exit_status},
          .sweep = std::move(figures)};
}

std::string summary(const Sweep& sweep, const Swept& swept, const SweepOptions& options) {
  const Statistics& statistics = swept.statistics;
  std::string text = fmt::format("{}: {} of {} runs of {}", sweep.name(), statistics.runs, swept.runs,
                                 printable_name(sweep.setup().request().experiment.string()));
  if (swept.wall_time > 0) text += fmt::format(", {:.3g} s", swept.wall_time);
  for (std::size_t i = 0; i < kRunEnds; ++i) {
    if (statistics.ends[i] == 0) continue;
    text += fmt::format("\n  {:<10} {}", name_of(static_cast<RunEnd>(i)), statistics.ends[i]);
    if (static_cast<RunEnd>(i) == RunEnd::held) continue;
    text += fmt::format(", first run {}{}", statistics.first[i],
                        statistics.code[i].empty() ? "" : " (" + statistics.code[i] + ")");
  }
  text += fmt::format("\n  {:<32}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}  run\n", "", "mean", "std",
                      "50 %", "90 %", "99 %", "99.9 %", "max");
  for (std::size_t i = 0; i < statistics.columns.size(); ++i) {
    const ColumnStatistics& column = statistics.columns[i];
    const auto& told = sweep.telling().columns[i];
    if (column.measured == 0) continue;
    text += fmt::format("  {:<32}{:>12.6g}{:>12.4g}",
                        told.unit == "1" ? told.name : told.name + " [" + told.unit + "]", column.mean,
                        column.deviation);
    for (const double value : column.quantiles) text += fmt::format("{:>12.6g}", value);
    text += fmt::format("{:>12.6g}  {}\n", column.most, column.run_of_most);
  }
  for (std::size_t i = 0; i < statistics.bounds.size() && swept.is_whole(); ++i)
    text += fmt::format("  {:<10} {}: {:.6g} %\n", statistics.bounds[i].is_held ? "held" : "missed",
                        text_of(sweep.bounds()[i]), 100 * part_held(statistics.bounds[i], statistics));
  for (const auto& line : swept.missed) text += "  " + line + "\n";
  if (swept.interrupted)
    text += options.out.empty() ? "  interrupted; nothing is kept without --out\n"
                                : "  interrupted; the same command goes on with the rest\n";
  else if (!options.out.empty() && swept.is_whole() && options.part.is_whole())
    text += fmt::format("  kept in {}: table.csv, {}summary.json\n", printable_name(options.out),
                        hdf5_here() != nullptr ? "table.h5, " : "");
  else if (!options.out.empty())
    text += fmt::format("  kept in {}; once all shards have ended, --merge makes the table\n",
                        printable_name(options.out));
  return text;
}

nlohmann::json json_of(const Sweep& sweep, const Swept& swept, const SweepOptions& options) {
  const Statistics& statistics = swept.statistics;
  nlohmann::json json = {{"sweep", sweep.name()},
                         {"experiment", sweep.setup().request().experiment.string()},
                         {"runs", swept.runs},
                         {"done", statistics.runs},
                         {"interrupted", swept.interrupted},
                         {"wall_time", swept.wall_time},
                         {"missed", swept.missed},
                         {"exit_status", swept.exit_status},
                         {"ends", nlohmann::json::object()},
                         {"columns", nlohmann::json::object()},
                         {"expect", nlohmann::json::array()}};
  if (!options.out.empty()) json["folder"] = options.out;
  for (std::size_t i = 0; i < kRunEnds; ++i) {
    if (statistics.ends[i] == 0) continue;
    auto& end = json["ends"][std::string(name_of(static_cast<RunEnd>(i)))];
    end = {{"runs", statistics.ends[i]}, {"first", statistics.first[i]}};
    if (!statistics.code[i].empty()) end["error"] = statistics.code[i];
  }
  for (std::size_t i = 0; i < statistics.columns.size(); ++i) {
    const ColumnStatistics& column = statistics.columns[i];
    const auto& told = sweep.telling().columns[i];
    json["columns"][told.name] = {{"unit", told.unit},
                                  {"measured", column.measured},
                                  {"mean", column.mean},
                                  {"std", column.deviation},
                                  {"min", column.least},
                                  {"max", column.most},
                                  {"run_of_min", column.run_of_least},
                                  {"run_of_max", column.run_of_most}};
    for (std::size_t k = 0; k < column.quantiles.size(); ++k)
      json["columns"][told.name][fmt::format("p{:.9g}", 100 * ColumnStatistics::kShares[k])] =
          column.quantiles[k];
  }
  for (std::size_t i = 0; i < statistics.bounds.size(); ++i) {
    const BoundStatistics& bound = statistics.bounds[i];
    nlohmann::json one = {{"text", text_of(sweep.bounds()[i])},
                          {"share", sweep.bounds()[i].share},
                          {"found", part_held(bound, statistics)},
                          {"held", bound.is_held}};
    if (bound.worst)
      one["worst"] = {
          {"run", *bound.worst}, {"missed", bound.missed}, {"command", sweep.command(*bound.worst)}};
    json["expect"].push_back(one);
  }
  return json;
}

}  // namespace mixloop
