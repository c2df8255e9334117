// SPDX-License-Identifier: MIT
#include "processes/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <system_error>

#include "dynamics/program/processor.hpp"
#include "loop/cases.hpp"
#include "loop/result.hpp"
#include "notation/long_work.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "processes/called_as.hpp"
#include "processes/result_json.hpp"
#include "processes/standard_output.hpp"

namespace mixloop {
namespace {

constexpr int kBrokenPipe = 128 + SIGPIPE;  ///< as a shell has it

/// Without throwing, whatever became of stderr.
void say(const char* program, const std::string& message) {
  std::fputs(fmt::format("{}: {}\n", program, printable(message)).c_str(), stderr);
}

int report(bool json, const char* program, const std::string& code, const std::string& found,
           const Place& place, int status) {
  const std::string where = to_string(place), message = as_called(found);
  if (json)
    print_json({{"error", {{"code", code}, {"message", printable(message)}, {"where", where}}}});
  else
    say(program, where + (where.empty() ? "" : ": ") + message);
  return status;
}

/// Those that begin as the word does are nearer than any others.
std::string likely(const std::string& word, const std::vector<std::string>& names) {
  for (const auto& name : names)
    if (word.size() > 1 && name.starts_with(word)) return "; did you mean '" + name + "'?";
  return suggestion(word, names);
}

/// Of a line that can't be parsed: the first word that is no command or no option, and what may be meant.
std::optional<std::string> misspelt(int argc, char** argv, const CLI::App& app) {
  const CLI::App* command = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (const std::string name = word.substr(0, word.find('=')); name.starts_with("--") && name.size() > 2) {
      if (command->get_option_no_throw(name) != nullptr) continue;
      std::vector<std::string> names;
      for (const auto* option : command->get_options())
        for (const auto& known : option->get_lnames()) names.push_back("--" + known);
      return fmt::format("{} has no option {}{}", command == &app ? "the program" : command->get_name(),
                         in_quotes(name), likely(name, names));
    }
    const auto commands = command->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty() || word.starts_with('-')) continue;
    const auto at = std::ranges::find(commands, word, &CLI::App::get_name);
    if (at != commands.end()) {
      command = *at;
      continue;
    }
    std::vector<std::string> names;
    for (const auto* known : commands) names.push_back(known->get_name());
    return fmt::format("there is no command {}{}", in_quotes(word), likely(word, names));
  }
  return std::nullopt;
}

/// What all help ends with, for who reads it here.
void footers_as_called(CLI::App& app) {
  app.footer(as_called(app.get_footer()));
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    footers_as_called(*command);
}

/// Parses and calls back; errors are told. Throws std::system_error where stdout can't be written.
int obeyed(int argc, char** argv, CLI::App& app, const int& status, bool json, const char* program) {
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::Success& help) {
    footers_as_called(app);
    std::ostringstream out;
    const int result = app.exit(help, out, out);
    fmt::print("{}", out.str());
    return result;
  } catch (const CLI::ParseError& error) {
    const std::string message = misspelt(argc, argv, app).value_or(error.what());
    if (json) return report(json, program, "command_line", message, {}, kBadInput);
    say(program, message + "\nRun with --help for how it is used.");
    return kBadInput;
  } catch (const Interrupted& interrupted) {
    return report(json, program, "interrupted", interrupted.what(), {}, kInterrupted);
  } catch (const InputError& error) {
    return report(json, program, error.code, error.message, error.place, kBadInput);
  } catch (const RunFault& error) {
    return report(json, program, error.code, error.what(), {}, kRunFault);
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) throw;
    return report(json, program, "internal", error.what(), {}, kRunFault);
  } catch (const std::bad_alloc&) {
    return report(json, program, "out_of_memory",
                  "there is not enough memory for it; a shorter path, fewer laps or a lower rate need less",
                  {}, kRunFault);
  } catch (const std::exception& error) {
    return report(json, program, "internal", error.what(), {}, kRunFault);
  }
}

/// The exit status of one that came to `status`, once all that it said is written. A reader that has gone is
/// no error, and worth no word.
int once_written(int status, const char* program) {
  const int failure = standard_output_failure();
  if (failure == 0) return status;
  if (failure == EPIPE) return kBrokenPipe;
  say(program, std::string("stdout can't be written: ") + std::strerror(failure));
  return kRunFault;
}

}  // namespace

void say_complaint(const std::string& complaint) {
  static std::once_flag said, said_of_processor;
  if (!has_fma())
    std::call_once(said_of_processor, [] {
      fmt::print(
          stderr,
          "mixloop: this processor has no fused multiply-add: programs have the same bits, but take several "
          "times as long\n");
    });
  if (complaint.empty()) return;
  std::call_once(
      said, [&] { fmt::print(stderr, "mixloop: programs are interpreted, not compiled: {}\n", complaint); });
}

int run_command_line(int argc, char** argv, CLI::App& app, const int& status) {
  open_standard_files();
  bool json = false;
  for (int i = 1; i < argc; ++i) json = json || std::strcmp(argv[i], "--json") == 0;
  const char* program = std::strrchr(argv[0], '/') ? std::strrchr(argv[0], '/') + 1 : argv[0];
  int result = kRunFault;
  try {
    result = obeyed(argc, argv, app, status, json, program);
  } catch (const std::system_error& error) {
    remember_output_failure(error.code().value());
  }
  return once_written(result, program);
}

std::vector<Override> CommonOptions::overrides() const {
  std::vector<Override> all;
  for (const auto& text : sets) all.push_back(parse_override(text));
  return all;
}

void CommonOptions::take_case(const std::string& experiment, const std::string& name) {
  if (name.empty()) return;
  const auto of_case = case_named(experiment, name).sets;
  sets.insert(sets.begin(), of_case.begin(), of_case.end());
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

void add_case_option(CLI::App& command, std::string& name) {
  command.add_option("--case", name, "one of the experiment's cases, by its name, e.g. 'payload=2 kg'")
      ->type_name("NAME");
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
      .add_option_function<std::string>(
          "--evaluation", [&evaluation](const std::string& way) { evaluation = kWays.at(way); },
          "of the equations of motion: machine_code (default: compiled once, then fast), interpreter (the "
          "same "
          "bytes, slower) or reference (the equations as they are written, for comparison)")
      ->check(CLI::IsMember({"machine_code", "interpreter", "reference"}).description(""))
      ->type_name("HOW");
}

void print_json(const nlohmann::json& json) { fmt::print("{}\n", json_text(json, 2)); }

}  // namespace mixloop
