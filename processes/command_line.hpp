// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop {

/// Runs a command line: parses, calls back, and turns every error into a message (or, with --json, into
/// {"error": {code, message, where}} on stdout) and an exit status: 2 for bad input, 3 for a fault.
int run_command_line(int argc, char** argv, CLI::App& app, const int& status);

/// The options that all commands on an experiment or a scene share.
struct CommonOptions {
  bool json = false;
  std::vector<std::string> sets;

  std::vector<Override> overrides() const;
};
void add_common_options(CLI::App& command, CommonOptions& options);

/// `--evaluation`: how the equations of motion are evaluated.
void add_evaluation_option(CLI::App& command, Evaluation& evaluation);

/// Says on stderr, once a process, why programs are interpreted that should have been compiled, if any is
/// (Equations::complaint).
void say_complaint(const std::string& complaint);

/// One JSON object on stdout, and nothing else.
void print_json(const nlohmann::json& json);

}  // namespace mixloop
