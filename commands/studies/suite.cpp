// SPDX-License-Identifier: MIT
#include "commands/studies/suite.hpp"

#include <filesystem>
#include <functional>
#include <map>

#include "loop/cases.hpp"
#include "notation/utf8.hpp"
#include "sweep/request.hpp"

namespace mixloop {
namespace {

void add_runs(const std::string& file, std::vector<SuiteRun>& runs) {
  const std::string stem = printable_name(std::filesystem::path(file).stem().string());
  if (is_sweep(file)) {
    runs.push_back({.name = name_of_sweep(file), .file = file, .is_sweep = true});
    return;
  }
  try {
    const auto cases = cases_of(file);
    for (const Case& one : cases)
      runs.push_back({.name = name_with_case(stem, one.name), .file = file, .sets = one.sets});
    if (cases.empty()) runs.push_back({.name = stem, .file = file});
  } catch (const InputError& error) {
    runs.push_back({.name = stem, .file = file, .unusable = error});
  }
}

/// Gives those whose name is another's too what `renamed` makes of it.
void tell_apart(std::vector<SuiteRun>& runs,
                const std::function<std::string(const SuiteRun&, int before)>& renamed) {
  std::map<std::string, int> all, seen;
  for (const SuiteRun& run : runs) ++all[run.name];
  for (SuiteRun& run : runs) {
    const std::string name = run.name;
    if (all[name] > 1) run.name = renamed(run, seen[name]);
    ++seen[name];
  }
}

}  // namespace

std::vector<SuiteRun> suite_of(const std::vector<std::string>& files) {
  std::vector<SuiteRun> runs;
  for (const auto& file : files) add_runs(file, runs);
  tell_apart(runs, [](const SuiteRun& run, int) {
    const auto folder = std::filesystem::path(run.file).parent_path();
    return printable_name((folder / run.name).generic_string());
  });
  tell_apart(runs, [](const SuiteRun& run, int before) {
    return before == 0 ? run.name : run.name + " #" + std::to_string(before + 1);
  });
  return runs;
}

}  // namespace mixloop
