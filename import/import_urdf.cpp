// SPDX-License-Identifier: MIT
#include "import/import_urdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/singular_mass.hpp"
#include "import/experiment_text.hpp"
#include "import/inertia.hpp"
#include "import/motion.hpp"
#include "import/read_robot.hpp"
#include "import/scene_text.hpp"
#include "import/yaml_text.hpp"
#include "notation/nearest.hpp"
#include "notation/text_file.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostMotors = 64;

bool is_free(const Robot::Joint& joint, const std::string& symbol, const ImportOptions& options) {
  return std::any_of(options.free.begin(), options.free.end(),
                     [&](const std::string& name) { return name == joint.name || name == symbol; });
}

void refuse_unknown_free(const Robot& robot, const SceneNames& names, const ImportOptions& options) {
  std::vector<std::string> known;
  for (std::size_t j = 0; j < robot.joints.size(); ++j)
    if (robot.joints[j].moves() && !robot.joints[j].mimic) {
      known.push_back(robot.joints[j].name);
      if (names.joints[j] != robot.joints[j].name) known.push_back(names.joints[j]);
    }
  for (const std::string& name : options.free)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError("unknown_value", {"--free"},
                       in_quotes(name) + " is no joint that moves by itself" + suggestion(name, known));
}

Roles roles_of(const Robot& robot, const SceneNames& names, const ImportOptions& options,
               const std::string& file) {
  refuse_unknown_free(robot, names, options);
  Roles roles;
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const auto& joint = robot.joints[j];
    if (!joint.moves()) continue;
    auto& role = joint.mimic                                ? roles.mimics
                 : is_free(joint, names.joints[j], options) ? roles.free
                                                            : roles.motors;
    role.push_back(static_cast<int>(j));
  }
  if (roles.motors.empty())
    throw InputError("no_motor", {file},
                     roles.free.empty()
                         ? "no joint moves: all are fixed, floating or planar; expected one that is "
                           "revolute, continuous or prismatic"
                         : "each joint that moves by itself is --free; expected one with a motor");
  if (roles.motors.size() + roles.free.size() > kMostMotors)
    throw InputError("too_large", {file},
                     fmt::format("{} joints move by themselves; expected {} at most",
                                 roles.motors.size() + roles.free.size(), kMostMotors));
  return roles;
}

/// How many joints move a link.
int joints_below(const Robot& robot, int link) {
  int count = 0;
  for (int j = robot.links[static_cast<std::size_t>(link)].joint; j >= 0;) {
    const auto& joint = robot.joints[static_cast<std::size_t>(j)];
    count += joint.moves() ? 1 : 0;
    j = robot.links[static_cast<std::size_t>(joint.parent)].joint;
  }
  return count;
}

int named_tip(const Robot& robot, const std::string& name) {
  std::vector<std::string> moved;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (joints_below(robot, static_cast<int>(i)) > 0) moved.push_back(robot.links[i].name);
  const auto found = std::find_if(robot.links.begin(), robot.links.end(),
                                  [&](const Robot::Link& link) { return link.name == name; });
  if (found == robot.links.end() || std::find(moved.begin(), moved.end(), name) == moved.end())
    throw InputError("unknown_value", {"--tip"},
                     in_quotes(name) +
                         (found == robot.links.end() ? " is no link" : " is a link that no joint moves") +
                         suggestion(name, moved));
  return static_cast<int>(found - robot.links.begin());
}

/// The links that move and on which nothing hangs.
std::vector<int> moved_leaves(const Robot& robot) {
  std::vector<bool> is_leaf(robot.links.size(), true);
  for (const auto& joint : robot.joints) is_leaf[static_cast<std::size_t>(joint.parent)] = false;
  std::vector<int> leaves;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (is_leaf[i] && joints_below(robot, static_cast<int>(i)) > 0) leaves.push_back(static_cast<int>(i));
  return leaves;
}

/// Of them the one that most joints move, of several the first.
int farthest(const Robot& robot, const std::vector<int>& leaves) {
  return *std::max_element(leaves.begin(), leaves.end(), [&](int one, int other) {
    return joints_below(robot, one) < joints_below(robot, other);
  });
}

void list_standing_inertias(const Robot& robot, LeftBehind& left) {
  const std::vector<bool> moved = moved_links(robot);
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (robot.links[i].inertial && !moved[i])
      left.add("inertias of links that stand still", robot.links[i].name, robot.links[i].inertial->place);
}

/// A scene's text, loaded; what is wrong with it is told of the file that it was made of.
std::shared_ptr<const Scene> loaded(const std::string& text, const std::string& file) {
  try {
    auto scene = std::make_shared<const Scene>(load_scene(parse_document(text, "scene")));
    require_inertia(scene, scene->default_parameters());
    return scene;
  } catch (const InputError& error) {
    throw InputError(error.code, {file}, "what it describes can't be a scene: " + error.message);
  }
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
  const Roles roles = roles_of(robot, names, options, file);
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
  made.experiment = experiment_head(made, file) +
                    experiment_text(made.name + ".scene.yaml", robot, names, roles, home, motion,
                                    moderate_tuning(draft, robot, roles, motion), limits);
  return made;
}

Imported import_urdf_file(const std::string& file, const ImportOptions& options) {
  constexpr std::size_t kMostRead = (4 << 20) + 1;
  return import_urdf(read_file(file, kMostRead), file, options);
}

}  // namespace mixloop
