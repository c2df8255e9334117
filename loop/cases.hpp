// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mixloop {

/// One of an experiment's `cases`: what it sets, `key=value` as `--set` takes them.
struct Case {
  std::string name;  ///< e.g. "payload=2 kg", "payload=2 kg, rate=500 Hz"
  std::vector<std::string> sets;
};

/// The cases of an experiment file, all combinations of what its `cases` list; empty where it has none.
/// Throws InputError.
std::vector<Case> cases_of(const std::filesystem::path& experiment);

/// The one of that name. Throws InputError("unknown_value") with those that there are.
Case case_named(const std::filesystem::path& experiment, const std::string& name);

/// An experiment's name with its case's: `paper[payload=2 kg]`.
std::string name_with_case(const std::string& experiment, const std::string& name);

}  // namespace mixloop
