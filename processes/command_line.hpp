// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace CLI {
class App;
}

namespace mixloop {

/// Runs a command line: parses, calls back, and turns every error into a message (or, with --json, into
/// {"error": {code, message, where}} on stdout) and an exit status: 2 for bad input, 3 for a fault, of which
/// one is that what was said could not be written, 130 for what was interrupted.
int run_command_line(int argc, char** argv, CLI::App& app, const int& status);

/// The options that all commands on an experiment or a scene share.
struct CommonOptions {
  bool json = false;
  std::vector<std::string> sets;

  std::vector<Override> overrides() const;
  /// Puts what a case of the experiment sets before `sets`; nothing where the name is empty.
  void take_case(const std::string& experiment, const std::string& name);
};
void add_common_options(CLI::App& command, CommonOptions& options);

/// The experiment file, first of a command's words.
void add_experiment_option(CLI::App& command, std::string& experiment,
                           const std::string& what = "the experiment file");

/// `--case`: one of the experiment's cases.
void add_case_option(CLI::App& command, std::string& name);

/// An option of so many seconds, from 0.05 to `most`.
void add_seconds_option(CLI::App& command, const std::string& name, double& seconds, const std::string& what,
                        double most = 3600);

/// `--evaluation`: how the equations of motion are evaluated.
void add_evaluation_option(CLI::App& command, Evaluation& evaluation);

/// Says on stderr, once a process, why programs are interpreted that should have been compiled, if any is
/// (Equations::complaint), and where the processor makes them slow.
void say_complaint(const std::string& complaint);

/// One JSON object on stdout, and nothing else.
void print_json(const nlohmann::json& json);

}  // namespace mixloop
