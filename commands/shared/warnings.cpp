// SPDX-License-Identifier: MIT
#include "commands/shared/warnings.hpp"

#include <fmt/format.h>

#include "loop/recorded_plant.hpp"
#include "loop/review.hpp"
#include "stability/warning.hpp"

namespace mixloop {

std::vector<std::string> warnings_of(const Experiment& experiment, const Plan& plan, bool quiet) {
  std::vector<std::string> warnings = experiment.scene->warnings;
  if (auto room = require_room(experiment, plan); !room.empty()) warnings.push_back(std::move(room));
  if (auto doubt = step_doubt(experiment, plan)) warnings.push_back(std::move(doubt->text));
  for (auto& warning : stability_warnings(experiment, plan)) warnings.push_back(std::move(warning));
  say(warnings, quiet);
  return warnings;
}

void say(const std::vector<std::string>& warnings, bool quiet) {
  if (!quiet)
    for (const auto& warning : warnings) fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace mixloop
