// SPDX-License-Identifier: MIT
#include "commands/warnings.hpp"

#include <fmt/format.h>

#include "stability/warning.hpp"

namespace mixloop {

std::vector<std::string> warnings_of(const Experiment& experiment, const Plan& plan, bool quiet) {
  std::vector<std::string> warnings = experiment.scene->warnings;
  for (auto& warning : stability_warnings(experiment, plan)) warnings.push_back(std::move(warning));
  if (!quiet)
    for (const auto& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
  return warnings;
}

}  // namespace mixloop
