// SPDX-License-Identifier: MIT
#include "dynamics/assembly/assemble.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <numbers>

#include "commands/commands.hpp"
#include "commands/shared/progress.hpp"
#include "loop/experiment.hpp"
#include "notation/number_text.hpp"
#include "processes/command_line.hpp"

namespace mixloop {
namespace {

struct AssembleLine : CommonOptions {
  std::string scene;
  int seeds = 200;
};

std::string value_text(double value, bool turns) {
  return turns ? fmt::format("{:.12g} deg", value * 180 / std::numbers::pi) : fmt::format("{:.12g} m", value);
}

/// A line to paste into the scene: the motors and the coordinates without a formula.
std::string home_text(const Scene& scene, const Branch& branch) {
  std::string text;
  const auto add = [&](const std::string& name, double value, bool turns) {
    text += (text.empty() ? "" : ", ") + name + ": " + value_text(value, turns);
  };
  for (int i = 0; i < scene.n(); ++i) {
    const auto& psi = scene.independent[static_cast<std::size_t>(i)];
    add(psi.name, scene.home[static_cast<std::size_t>(i)], !psi.linear);
  }
  for (int j = 0; j < scene.m(); ++j) {
    const auto& coordinate = scene.coordinates[static_cast<std::size_t>(j)];
    if (coordinate.is_solved()) add(coordinate.name, branch.q[static_cast<std::size_t>(j)], scene.turns(j));
  }
  return "home: {" + text + "}";
}

nlohmann::json as_json(const Scene& scene, const std::vector<Branch>& found) {
  auto list = nlohmann::json::array();
  for (const Branch& branch : found) {
    nlohmann::json q;
    for (std::size_t j = 0; j < branch.q.size(); ++j) q[scene.coordinates[j].name] = branch.q[j];
    list.push_back({{"q", q},
                    {"from_guess", branch.from_guess},
                    {"closure_residual", branch.residual},
                    {"iterations", branch.iterations},
                    {"singular", branch.is_singular},
                    {"home", home_text(scene, branch)}});
  }
  return list;
}

void print_branches(const Scene& scene, const std::vector<Branch>& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Branch& branch = found[i];
    fmt::print("{} {}: {:.4g} from the guess, closes to {:.1e} after {} iterations{}\n",
               i == 0 ? "branch" : "other branch", i + 1, branch.from_guess, branch.residual,
               branch.iterations, branch.is_singular ? "; singular" : "");
    for (int j = 0; j < scene.m(); ++j)
      fmt::print("  {:<16} {}{}\n", scene.coordinates[static_cast<std::size_t>(j)].name,
                 value_text(branch.q[static_cast<std::size_t>(j)], scene.turns(j)),
                 scene.coordinates[static_cast<std::size_t>(j)].is_solved() ? "" : "  by its formula");
    fmt::print("  {}\n", home_text(scene, branch));
  }
}

int run(const AssembleLine& options) {
  StopSwitch stop;
  stop.turn_on_signals();
  const ShownWork work(stop);
  const Scene scene = read_scene(std::filesystem::path(options.scene), options.overrides());
  if (scene.closures.empty())
    throw InputError(
        "missing_key", {options.scene},
        "the scene has no closures: each coordinate follows from its formula, and there is nothing "
        "to put together; expected 'closures'");
  const std::vector<Branch> found = branches(scene, options.seeds);
  if (options.json)
    print_json({{"branches", as_json(scene, found)}});
  else
    print_branches(scene, found);
  load_scene(std::filesystem::path(options.scene), options.overrides());  // says what is wrong with it
  return 0;
}

}  // namespace

void add_assemble_command(CLI::App& command, int& status) {
  auto options = std::make_shared<AssembleLine>();
  command.add_option("scene", options->scene, "the scene file")->required()->type_name("SCENE");
  command.add_option("--seeds", options->seeds, "random guesses about the scene's own")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  add_common_options(command, *options);
  command.footer(
      "Prints each way in which the mechanism closes at home that the guesses find, the nearest to the "
      "scene's "
      "guess first, and for each a line `home: ...` to paste into the scene, which picks it. Exit status 2, "
      "with "
      "the reason, where the scene can't be put together, or could be in more than one way as near.\n"
      "Example:\n"
      "  mixloop assemble scenes/four_bar.yaml");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
