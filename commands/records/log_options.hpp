// SPDX-License-Identifier: MIT
#pragma once

#include "processes/command_line.hpp"
#include "report/run_file.hpp"

namespace mixloop {

/// What commands that read a log or a kept result share: `--experiment`, `--session`.
struct LogOptions : CommonOptions {
  std::string experiment;
  ReadOptions read;

  /// Loads `--experiment` with its overrides into `read`; throws InputError where there are overrides alone.
  void take_experiment();
};
void add_log_options(CLI::App& command, LogOptions& options);

}  // namespace mixloop
