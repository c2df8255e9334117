// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/program/firmware.hpp"
#include "loop/output_file.hpp"
#include "loop/result.hpp"
#include "notation/long_work.hpp"
#include "processes/command_line.hpp"
#include "sweep/kernel/kernel_source.hpp"

namespace mixloop {
namespace {

struct CompileLine : CommonOptions {
  std::string scene, emit, file;
  std::vector<std::string> purposes;
  bool c_library = false;
};

std::vector<Purpose> purposes_of(const CompileLine& options) {
  std::vector<Purpose> purposes;
  for (Purpose purpose : kPurposes)
    if (options.purposes.empty() || std::find(options.purposes.begin(), options.purposes.end(),
                                              name_of(purpose)) != options.purposes.end())
      purposes.push_back(purpose);
  return purposes;
}

std::string source_of(const CompileLine& options, const std::shared_ptr<const Scene>& scene) {
  if (options.emit == "cuda") return kernel_source({scene, scene, true, true}, KernelTarget::cuda);
  return firmware_source(scene, purposes_of(options),
                         options.c_library ? Trigonometry::c_library : Trigonometry::inlined);
}

int write_source(const CompileLine& options, const std::shared_ptr<const Scene>& scene) {
  const std::string source = source_of(options, scene);
  if (options.file.empty()) {
    fmt::print("{}", source);
    return 0;
  }
  write_file(options.file, source);
  if (options.json) print_json({{"file", options.file}, {"bytes", source.size()}});
  return 0;
}

/// Builds one program; how that went.
nlohmann::json built(const std::shared_ptr<const Scene>& scene, Purpose purpose) {
  const auto start = std::chrono::steady_clock::now();
  const auto equations = equations_of(scene, Evaluation::machine_code, {purpose});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  say_complaint(equations->complaint());
  return {{"evaluation", name_of(equations->evaluation())}, {"seconds", seconds}};
}

/// What is built before an interruption stays in the cache, and is told.
int build(const CompileLine& options, const std::shared_ptr<const Scene>& scene) {
  auto all = nlohmann::json::object();
  int status = kHeld;
  try {
    for (Purpose purpose : purposes_of(options)) {
      const auto& one = all[std::string(name_of(purpose))] = built(scene, purpose);
      if (!options.json)
        fmt::print("{:<26}{:<14}{:8.1f} ms\n", name_of(purpose), one["evaluation"].get<std::string>(),
                   1e3 * one["seconds"].get<double>());
    }
  } catch (const Interrupted& interrupted) {
    if (!options.json) throw;
    status = kInterrupted;
  }
  if (options.json) print_json(all);
  return status;
}

int run(const CompileLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const auto scene = std::make_shared<const Scene>(load_scene(options.scene, options.overrides()));
  return options.emit.empty() ? build(options, scene) : write_source(options, scene);
}

}  // namespace

void add_compile_command(CLI::App& command, int& status) {
  auto options = std::make_shared<CompileLine>();
  std::vector<std::string> names;
  for (Purpose purpose : kPurposes) names.emplace_back(name_of(purpose));
  command.add_option("scene", options->scene, "the scene file")->required()->type_name("SCENE");
  command.add_option("--emit", options->emit, "write the source instead")
      ->check(CLI::IsMember({"cpp", "cuda"}));
  command.add_option("--purpose", options->purposes, "only these; all when omitted")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command.add_option("--file", options->file, "where the source goes; standard output when omitted")
      ->type_name("FILE");
  command.add_flag("--c-library", options->c_library, "sine and cosine from <math.h>, not inlined");
  add_common_options(command, *options);
  command.footer(
      "The source is C++17 with a C interface and needs nothing but <math.h>. With --emit cuda it is the "
      "whole closed\n"
      "loop of a sweep's run (law, plant by rk4, what is measured), a run a thread: for nvcc -fmad=false.\n"
      "Example:\n"
      "  mixloop compile scenes/mixed_loop_robot.yaml --emit cpp --purpose forward_dynamics,mass_times "
      "--file robot.cpp");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
