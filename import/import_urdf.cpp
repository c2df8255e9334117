// SPDX-License-Identifier: MIT
#include "import/import_urdf.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/singular_mass.hpp"
#include "import/choices.hpp"
#include "import/experiment_text.hpp"
#include "import/inertia.hpp"
#include "import/motion.hpp"
#include "import/read_robot.hpp"
#include "import/scene_text.hpp"
#include "import/yaml_text.hpp"
#include "notation/text_file.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

void list_standing_inertias(const Robot& robot, LeftBehind& left) {
  const std::vector<bool> moved = moved_links(robot);
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (robot.links[i].inertial && !moved[i])
      left.add("inertias of links that stand still", robot.links[i].name, robot.links[i].inertial->place);
}

/// What `make` gives; what is wrong with it is told of the file that it is made of.
template <class Make>
auto made_of(const std::string& file, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.code, {file}, "what it describes can't be a scene: " + error.message);
  }
}

std::shared_ptr<const Scene> loaded(const std::string& text, const std::string& file) {
  return made_of(file, [&] {
    auto scene = std::make_shared<const Scene>(load_scene(parse_document(text, "scene")));
    require_inertia(scene, scene->default_parameters());
    return scene;
  });
}

/// What an experiment says of itself before it begins.
std::string experiment_head(const Imported& made, const std::string& file) {
  return comment(fmt::format(
      "The motors of {} from home to another pose and back by computed torque, within the limits "
      "of {} (`mixloop import`). The gains give each motor, the others free, two equal poles.",
      printable_name(made.name), printable_name(std::filesystem::path(file).filename().string())));
}

/// What a scene made of a robot says of itself before it begins.
std::string head_of(const Imported& made, const std::string& file) {
  std::string head =
      comment(fmt::format("{}, imported from {} by `mixloop import`.", printable_name(made.name),
                          printable_name(std::filesystem::path(file).filename().string())));
  head += comment(fmt::format("Frame 0 is the link {}; the end effector is the origin of {}.",
                              printable_name(made.root), printable_name(made.tip)));
  for (const auto& [from, to] : made.renamed)
    head += comment(fmt::format("Renamed: {} is {}.", printable_name(from), printable_name(to)));
  if (!made.left.kinds().empty()) head += "# Not carried over:\n";
  for (const auto& kind : made.left.kinds()) head += comment("- " + text_of(kind));
  return head + "\n";
}

}  // namespace

Imported import_urdf(const std::string& text, const std::string& file, const ImportOptions& options) {
  const XmlFile xml(text, file);
  const Robot robot = read_robot(xml);
  Imported made;
  made.name = file_name_of(options.name.empty() ? robot.name : options.name);
  const SceneNames names = names_in_scene(robot);
  const Roles roles = roles_of(robot, names, options.free, file);
  check_inertias(robot, options.any_inertia, made.left);
  list_standing_inertias(robot, made.left);
  list_left_behind(xml, robot, made.left);
  const std::vector<MotorLimits> limits = limits_of(robot, roles, made.left);
  const std::vector<int> leaves = moved_leaves(robot);
  const int tip = options.tip.empty() ? farthest(robot, leaves) : named_tip(robot, options.tip);
  const std::vector<double> home = home_within(limits, roles.free.size());

  const auto draft = loaded(scene_text(robot, names, roles, tip, "", home), file);
  const Motion motion = moderate_motion(draft, robot, roles, limits);
  for (const std::size_t motor : motion.overloaded) {
    const auto& joint = robot.joints[static_cast<std::size_t>(roles.motors[motor])];
    made.left.add("limits of effort that the weight alone comes too near to, of the joints", joint.name,
                  joint.place);
  }
  const Tuning tuning = made_of(file, [&] { return moderate_tuning(draft, robot, roles, motion); });
  const std::string scene = scene_text(robot, names, roles, tip, free_axes(draft, motion), home);
  loaded(scene, file);

  made.root = robot.links.front().name;
  made.tip = robot.links[static_cast<std::size_t>(tip)].name;
  for (const int leaf : leaves) made.leaves.push_back(robot.links[static_cast<std::size_t>(leaf)].name);
  made.renamed = names.renamed;
  for (const auto& [joints, list] :
       {std::pair{&roles.motors, &made.motors}, std::pair{&roles.free, &made.free},
        std::pair{&roles.mimics, &made.following}})
    for (const int j : *joints) list->push_back(names.joints[static_cast<std::size_t>(j)]);
  made.scene = head_of(made, file) + scene;
  made.experiment = experiment_head(made, file) + experiment_text(made.name + ".scene.yaml", robot, names,
                                                                  roles, home, motion, tuning, limits);
  return made;
}

Imported import_urdf_file(const std::string& file, const ImportOptions& options) {
  constexpr std::size_t kMostRead = (4 << 20) + 1;
  return import_urdf(read_file(file, kMostRead), file, options);
}

}  // namespace mixloop
