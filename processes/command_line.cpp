// SPDX-License-Identifier: MIT
#include "processes/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "loop/result.hpp"
#include "notation/long_work.hpp"

namespace mixloop {
namespace {

int report(bool json, const char* program, const std::string& code, const std::string& message,
           const Place& place, int status) {
  const std::string where = to_string(place);
  if (json)
    print_json({{"error", {{"code", code}, {"message", message}, {"where", where}}}});
  else
    fmt::print(stderr, "{}: {}{}{}\n", program, where, where.empty() ? "" : ": ", message);
  return status;
}

}  // namespace

void say_complaint(const std::string& complaint) {
  static std::once_flag said;
  if (complaint.empty()) return;
  std::call_once(
      said, [&] { fmt::print(stderr, "mixloop: programs are interpreted, not compiled: {}\n", complaint); });
}

int run_command_line(int argc, char** argv, CLI::App& app, const int& status) {
  bool json = false;
  for (int i = 1; i < argc; ++i) json = json || std::strcmp(argv[i], "--json") == 0;
  const char* program = std::strrchr(argv[0], '/') ? std::strrchr(argv[0], '/') + 1 : argv[0];
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    if (!json) {
      fmt::print(stderr, "{}: {}\nRun with --help for how it is used.\n", program, error.what());
      return kBadInput;
    }
    return report(json, program, "command_line", error.what(), {}, kBadInput);
  } catch (const Interrupted& interrupted) {
    return report(json, program, "interrupted", interrupted.what(), {}, kInterrupted);
  } catch (const InputError& error) {
    return report(json, program, error.code, error.message, error.place, kBadInput);
  } catch (const RunFault& error) {
    return report(json, program, error.code, error.what(), {}, kRunFault);
  } catch (const std::exception& error) {
    return report(json, program, "internal", error.what(), {}, kRunFault);
  }
}

std::vector<Override> CommonOptions::overrides() const {
  std::vector<Override> all;
  for (const auto& text : sets) all.push_back(parse_override(text));
  return all;
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--set", options.sets,
                  "override an entry, key=value; a scene's own by scene.KEY; may be repeated")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_flag("--json", options.json,
                   "print one JSON object on stdout and nothing else, errors included");
}

void add_experiment_option(CLI::App& command, std::string& experiment, const std::string& what) {
  command.add_option("experiment", experiment, what)->required()->type_name("EXPERIMENT");
}

void add_seconds_option(CLI::App& command, const std::string& name, double& seconds, const std::string& what,
                        double most) {
  command.add_option(name, seconds, what)->type_name("S")->check(CLI::Range(0.05, most));
}

void add_evaluation_option(CLI::App& command, Evaluation& evaluation) {
  static const std::map<std::string, Evaluation> kWays = {{"reference", Evaluation::reference},
                                                          {"interpreter", Evaluation::interpreter},
                                                          {"machine_code", Evaluation::machine_code}};
  command
      .add_option("--evaluation", evaluation,
                  "of the equations of motion: machine_code (default), interpreter or reference")
      ->transform(CLI::CheckedTransformer(kWays))
      ->type_name("HOW");
}

void print_json(const nlohmann::json& json) { fmt::print("{}\n", json.dump(2)); }

}  // namespace mixloop
