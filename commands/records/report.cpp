// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

#include "commands/commands.hpp"
#include "commands/records/log_options.hpp"
#include "commands/records/sweep_report.hpp"
#include "commands/records/web_page.hpp"
#include "commands/shared/children.hpp"
#include "commands/shared/progress.hpp"
#include "loop/output_file.hpp"
#include "notation/utf8.hpp"
#include "report/page.hpp"
#include "sweep/kept_sweep.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostBytes = 9'500'000;
constexpr std::size_t kMostBuckets = std::size_t{1} << 15;  // a curve, of all runs together
constexpr std::size_t kMostRuns = 8;                        // as many as can be told apart

struct ReportLine : LogOptions {
  std::vector<std::string> paths;
  std::string out;
};

std::string default_out(const std::filesystem::path& first) {
  if (std::filesystem::is_directory(first)) return (first / "report.html").string();
  return std::filesystem::path(first).replace_extension(".html").string();
}

/// Labels that differ: by their sources where the experiments' names are the same.
void tell_apart(std::vector<ReportedRun>& runs) {
  std::vector<std::string> labels;
  for (const auto& run : runs) labels.push_back(run.label);
  for (auto& run : runs)
    if (std::count(labels.begin(), labels.end(), run.label) > 1)
      run.label += " (" + (std::filesystem::path(run.source) / "").parent_path().filename().string() + ")";
}

std::vector<ReportedRun> read_runs(ReportLine& options) {
  if (options.paths.size() > kMostRuns)
    throw InputError("too_many", {options.paths[kMostRuns]},
                     fmt::format("{} results; expected at most {}, which can be told apart",
                                 options.paths.size(), kMostRuns));
  options.take_experiment();
  std::size_t capacity = kMostBuckets;
  while (capacity * options.paths.size() > kMostBuckets) capacity /= 2;
  std::vector<ReportedRun> runs;
  for (const auto& path : options.paths) runs.push_back(read_run(path, options.read, capacity));
  tell_apart(runs);
  return runs;
}

/// Whether a sweep is to be reported. Throws InputError where it doesn't stand alone.
bool is_of_a_sweep(const ReportLine& options) {
  const auto sweep = std::ranges::find_if(options.paths, is_sweep_folder);
  if (sweep == options.paths.end()) return false;
  if (options.paths.size() > 1)
    throw InputError(
        "not_alone", {*sweep},
        "a sweep's folder beside other results; expected it alone: a sweep has a page of its own");
  if (!options.experiment.empty() || options.read.session != 0)
    throw InputError(
        "not_a_log", {*sweep},
        "a sweep's folder has no sessions, and says of which experiment it is; expected it without "
        "--session and --experiment");
  return true;
}

int run(ReportLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const bool of_a_sweep = is_of_a_sweep(options);
  const std::string page = web_page(of_a_sweep ? "sweep.html" : "report.html");
  const std::string out = options.out.empty() ? default_out(options.paths.front()) : options.out;
  if (of_a_sweep) {
    report_sweep(options.paths.front(), page, out, options.json);
    return 0;
  }
  std::vector<ReportedRun> runs = read_runs(options);
  const std::string text = report_page(page, runs, kMostBytes);
  write_file(out, text);
  nlohmann::json json = {{"file", out}, {"bytes", text.size()}, {"results", nlohmann::json::array()}};
  for (const auto& run : runs)
    json["results"].push_back({{"label", run.label},
                               {"source", run.source},
                               {"ticks", run.curves.ticks()},
                               {"ticks_per_bucket", run.curves.width()},
                               {"notes", run.notes}});
  if (options.json) {
    print_json(json);
    return 0;
  }
  for (const auto& run : runs) {
    fmt::print("{}: {} ticks of {}\n", run.label, run.curves.ticks(), run.source);
    for (const auto& note : run.notes) fmt::print("  {}\n", note);
  }
  fmt::print("{}: {:.1f} MB\n", printable_name(out), static_cast<double>(text.size()) * 1e-6);
  return 0;
}

}  // namespace

void add_report_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ReportLine>();
  command
      .add_option("results", options->paths,
                  "folders that --out kept, or LCM logs; several are overlaid; or the folder of one sweep")
      ->required()
      ->type_name("RESULT_DIR|LOG");
  command
      .add_option("--out", options->out,
                  "the page; report.html in the first folder, or LOG's name with .html")
      ->type_name("FILE");
  add_log_options(command, *options);
  command
      .add_option("--channel-prefix", options->read.prefix, "of a log's channels, " + options->read.prefix)
      ->type_name("PREFIX");
  add_common_options(command, *options);
  command.footer(
      "The page holds all that it shows and asks nothing of the network: the paper's figures 2 to 5, "
      "tracking error,\n"
      "coordinates, energy, command ages, inputs, versions and verdicts. Long runs are drawn by the least "
      "and the\n"
      "greatest of each few ticks, so that no peak is lost.\n"
      "Of a sweep: distributions, maps of two entries or an entry and what was measured, which entry moves "
      "it most, and\n"
      "the worst runs, each with its command; of a million runs as of ten (docs/sweeps.md).\n"
      "Examples:\n"
      "  mixloop simulate experiments/paper.yaml --out results/paper && mixloop report results/paper\n"
      "  mixloop report results/paper results/three --out compared.html\n"
      "  mixloop sweep experiments/payload.sweep.yaml --out results/payload && mixloop report "
      "results/payload\n"
      "  mixloop report lcm-log.00 --experiment experiments/paper.yaml      # lcm-logger's own");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
