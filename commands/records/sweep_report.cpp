// SPDX-License-Identifier: MIT
#include "commands/records/sweep_report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <stdexcept>

#include "commands/records/sweep_page.hpp"
#include "loop/kept_json.hpp"
#include "loop/output_file.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "processes/called_as.hpp"
#include "processes/command_line.hpp"
#include "report/page.hpp"
#include "sweep/folder.hpp"
#include "sweep/journal.hpp"

namespace mixloop {
namespace {

/// Runs in the cells of a map are told by 32 bits.
constexpr std::int64_t kMostSweptRuns = 0xffffffff;

std::string going_on(const KeptSweep& sweep, const std::filesystem::path& folder) {
  return as_called(sweep.called + " --out " + shell_word(folder.string()));
}

/// What was expected of shares of all runs, as the summary has it.
nlohmann::ordered_json expect_in(const std::filesystem::path& file, std::vector<std::string>& notes) {
  std::ifstream in(file);
  const auto summary = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!in || !summary.is_object()) {
    notes.push_back("There is no summary.json: what was expected of the runs isn't judged here.");
    return nlohmann::ordered_json::array();
  }
  using Entries = std::map<std::string, nlohmann::ordered_json>;
  return KeptJson(summary, file).value<std::vector<Entries>>("expect", {});
}

Reduction reduction_of(const KeptSweep& sweep, const KeptRuns& kept, const std::filesystem::path& folder) {
  try {
    return reduced(sweep, [&](const auto& told) { kept.each(told); });
  } catch (const std::invalid_argument& error) {
    throw InputError("wrong_size", {folder.string()},
                     std::string("its runs are not of the columns that asked.yaml names (") + error.what() +
                         "); expected what mixloop sweep --out keeps: the same command writes it again");
  }
}

}  // namespace

void report_sweep(const std::filesystem::path& folder, const std::string& page,
                  const std::filesystem::path& out, bool json) {
  const KeptSweep sweep = read_kept_sweep(folder);
  if (sweep.design.runs() > kMostSweptRuns)
    throw InputError(
        "too_large", {folder.string()},
        fmt::format("a sweep of {} runs; expected {} at most", sweep.design.runs(), kMostSweptRuns));
  const KeptRuns kept(journals_in(folder), sweep.sha256, sweep.columns.size());
  if (kept.done().empty())
    throw InputError("missing_runs", {folder.string()},
                     "none of its " + std::to_string(sweep.design.runs()) +
                         " runs is there yet; expected some: " + going_on(sweep, folder));
  const Reduction reduction = reduction_of(sweep, kept, folder);
  const std::int64_t done = reduction.ends.runs;
  std::vector<std::string> notes;
  auto expect = nlohmann::ordered_json::array();
  if (done < sweep.design.runs())
    notes.push_back(
        fmt::format("{} of {} runs are there, and nothing else is told here; what was expected "
                    "of all isn't judged yet. What is missing is run by: {}",
                    done, sweep.design.runs(), going_on(sweep, folder)));
  else
    expect = expect_in(folder / "summary.json", notes);
  const std::string text = with_data(page, sweep_page_data(sweep, reduction, expect, notes));
  write_file(out, text);
  if (json)
    return print_json({{"file", out.string()},
                       {"bytes", text.size()},
                       {"sweep", sweep.name},
                       {"runs", sweep.design.runs()},
                       {"done", done},
                       {"notes", notes}});
  fmt::print("{}: {} of {} runs in {}\n", sweep.name, done, sweep.design.runs(),
             printable_name(folder.string()));
  for (const auto& note : notes) fmt::print("  {}\n", note);
  fmt::print("{}: {:.2f} MB\n", printable_name(out.string()), static_cast<double>(text.size()) * 1e-6);
}

}  // namespace mixloop
