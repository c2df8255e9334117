// SPDX-License-Identifier: MIT
#include "commands/records/log_options.hpp"

#include <CLI/CLI.hpp>

#include "notation/errors.hpp"

namespace mixloop {

void LogOptions::take_experiment() {
  if (!experiment.empty())
    read.experiment = load_experiment(std::filesystem::path(experiment), overrides());
  else if (!sets.empty())
    throw InputError("command_line", {"--set"},
                     "overrides an experiment's entries; expected --experiment too");
}

void add_log_options(CLI::App& command, LogOptions& options) {
  command
      .add_option("--experiment", options.experiment,
                  "what a log was made with, where no inputs.json stands beside it")
      ->type_name("EXPERIMENT");
  command.add_option("--session", options.read.session, "which run of a log; the longest when omitted")
      ->type_name("ID");
}

}  // namespace mixloop
