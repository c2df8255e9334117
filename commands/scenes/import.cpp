// SPDX-License-Identifier: MIT
// A robot from elsewhere as a scene and an experiment.
#include "import/import_urdf.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>

#include "commands/commands.hpp"
#include "loop/output_file.hpp"
#include "loop/output_folder.hpp"
#include "notation/utf8.hpp"
#include "notation/words.hpp"
#include "processes/command_line.hpp"

namespace mixloop {
namespace {

struct ImportLine : ImportOptions {
  std::string file, out;
  bool force = false, json = false;
};

struct Written {
  std::filesystem::path scene, experiment;
};

Written files_of(const ImportLine& options, const Imported& made) {
  const std::filesystem::path folder(options.out);
  return {folder / (made.name + ".scene.yaml"), folder / (made.name + ".experiment.yaml")};
}

/// Both files, or none.
void write(const ImportLine& options, const Imported& made, const Written& files) {
  for (const auto& file : {files.scene, files.experiment})
    if (!options.force && std::filesystem::exists(file))
      throw InputError("file_exists", {file.string()},
                       "is there already; expected another --out or --name, or --force to write over it");
  prepare_folder(options.out);
  OutputFile scene(files.scene), experiment(files.experiment);
  scene.write(made.scene);
  experiment.write(made.experiment);
  scene.publish();
  experiment.publish();
}

nlohmann::json as_json(const Imported& made, const Written& files) {
  auto left = nlohmann::json::array(), renamed = nlohmann::json::array();
  for (const auto& kind : made.left.kinds())
    left.push_back({{"what", kind.what}, {"names", kind.names}, {"where", to_string(kind.place)}});
  for (const auto& [from, to] : made.renamed) renamed.push_back({{"from", from}, {"to", to}});
  return {{"scene", files.scene.string()},
          {"experiment", files.experiment.string()},
          {"root", made.root},
          {"tip", made.tip},
          {"leaves", made.leaves},
          {"motors", made.motors},
          {"free", made.free},
          {"following", made.following},
          {"renamed", renamed},
          {"not_carried_over", left}};
}

void print_summary(const Imported& made, const Written& files) {
  fmt::print("{}\n{}\n", printable_name(files.scene.string()), printable_name(files.experiment.string()));
  fmt::print("  motors        {}\n", joined(made.motors));
  if (!made.free.empty()) fmt::print("  free          {}\n", joined(made.free));
  if (!made.following.empty()) fmt::print("  following     {}\n", joined(made.following));
  fmt::print("  ground        the link {}\n  end effector  the link {}{}\n", printable_name(made.root),
             printable_name(made.tip),
             made.leaves.size() > 1
                 ? fmt::format(", of {} leaves (--tip takes another link)", made.leaves.size())
                 : "");
}

void say_what_changed(const Imported& made) {
  for (const auto& [from, to] : made.renamed)
    fmt::print(stderr, "mixloop: renamed: {} is {}\n", printable_name(from), printable_name(to));
  for (const auto& kind : made.left.kinds())
    fmt::print(stderr, "mixloop: {}: not carried over: {}\n", to_string(kind.place), text_of(kind));
}

int run(const ImportLine& options) {
  const Imported made = import_urdf_file(options.file, options);
  const Written files = files_of(options, made);
  write(options, made, files);
  if (options.json) {
    print_json(as_json(made, files));
    return 0;
  }
  print_summary(made, files);
  say_what_changed(made);
  return 0;
}

}  // namespace

void add_import_command(CLI::App& command, int& status) {
  auto options = std::make_shared<ImportLine>();
  command.add_option("file", options->file, "the URDF")->required()->type_name("ROBOT.urdf");
  command.add_option("--out", options->out, "the folder to write into; made where there is none")
      ->required()
      ->type_name("FOLDER");
  command.add_option("--name", options->name, "of the files; the robot's own unless given")
      ->type_name("NAME");
  command
      .add_option("--tip", options->tip,
                  "the link that is the end effector; unless given the leaf that most joints move")
      ->type_name("LINK");
  command.add_option("--free", options->free, "a joint without a motor; may be given several times")
      ->type_name("JOINT")
      ->allow_extra_args(false);
  command.add_flag(
      "--any-inertia", options->any_inertia,
      "take inertias that no real mass has (a moment larger than the sum of the others) as they are");
  command.add_flag("--force", options->force, "write over files that are there");
  command.add_flag("--json", options->json,
                   "print one JSON object on stdout and nothing else, errors included");
  command.footer(
      "Writes FOLDER/NAME.scene.yaml, the mechanism, and FOLDER/NAME.experiment.yaml, a moderate motion "
      "there and "
      "back\n"
      "within the robot's limits. What a scene can't hold (meshes, transmissions, Coulomb friction, floating "
      "joints,\n"
      "...) is listed on stderr and in the scene's head.\n"
      "Example:\n"
      "  mixloop import ur5.urdf --out robots\n"
      "  mixloop simulate robots/ur5.experiment.yaml");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace mixloop
