// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loop/result.hpp"

namespace mixloop {

/// One run of a suite: an experiment, a case of one, or a sweep.
struct SuiteRun {
  std::string name;  ///< unlike any other's, as it can be shown
  std::string file;
  std::vector<std::string> sets = {};       ///< of the case
  std::optional<InputError> unusable = {};  ///< why the file's cases can't be told
  bool is_sweep = false;                    ///< many runs, held as one
};

/// The runs of experiment files, in their order, an experiment's cases one after the other. Where two would
/// have the same name they have their path's, and where that is the same too, a number.
std::vector<SuiteRun> suite_of(const std::vector<std::string>& files);

}  // namespace mixloop
