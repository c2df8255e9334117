// SPDX-License-Identifier: MIT
#include "dynamics/scene/read_scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

void read_name(const Mapping& root, Scene& scene) {
  const NodePtr node = root.find("name");
  scene.name = node ? text_of(*node, "the scene's name")
                    : printable_name(std::filesystem::path(root.node().place.file).stem().string());
}

const std::vector<std::string>& prescribed_words() {
  static const std::vector<std::string> words{"x", "y", "z", "rx", "ry", "rz"};
  return words;
}

/// What a path says of the end effector: of its place, then of how it is turned.
void read_prescribed(const NodePtr& node, Scene::EndEffector& end_effector) {
  end_effector.axes.clear();
  for (const auto& item : items_within(node, 1, 6, "axes out of x, y, z, rx, ry, rz")) {
    const int word = static_cast<int>(word_of(*item, prescribed_words(), "an axis"));
    std::vector<int>& list = word < 3 ? end_effector.axes : end_effector.turns;
    if (std::ranges::count(list, word % 3) > 0)
      throw InputError("doubly_defined", item->place, "the axis '" + item->text + "' is given twice");
    if (word < 3 && !end_effector.turns.empty())
      throw InputError(
          "out_of_range", item->place,
          "the axis '" + item->text + "' after those of turning; expected x, y, z before rx, ry, rz");
    list.push_back(word % 3);
  }
  if (end_effector.axes.empty())
    throw InputError(
        "out_of_range", node->place,
        "the axes prescribe how the end effector is turned, and not where it is; expected at least "
        "one of x, y, z");
  const auto& turns = end_effector.turns;
  if (turns.size() == 2 || (turns.size() == 3 && !std::ranges::is_sorted(turns)))
    throw InputError(
        "out_of_range", node->place,
        "the end effector is turned by roll, pitch and yaw; expected rx, ry, rz in this order, one of "
        "them alone for what turns about that axis only, or 'direction' for where it points");
}

void read_end_effector(const Mapping& root, SceneDraft& draft) {
  auto& end_effector = draft.scene.end_effector;
  const NodePtr node = root.find("end_effector");
  if (!node) {
    end_effector.named = false;
    end_effector.point = draft.vector(nullptr, kLength, "the end effector's point", draft.fixed);
    return;
  }
  const Mapping entry = read_mapping(node, end_effector_keys());
  end_effector.frame = draft.frame(entry);
  end_effector.point = draft.vector(entry.find("point"), kLength, "the end effector's point", draft.fixed);
  if (const NodePtr axes = entry.find("axes")) read_prescribed(axes, end_effector);
  if (const NodePtr direction = entry.find("direction")) {
    if (!end_effector.turns.empty())
      throw InputError("doubly_defined", direction->place,
                       "the axes prescribe how the end effector is turned, and 'direction' where it points; "
                       "expected one of them");
    auto [x, y, z] = draft.axis(direction, "the end effector's direction");
    const double length = std::sqrt(x * x + y * y + z * z);
    end_effector.direction = {x / length, y / length, z / length};
  }
}

void read_home(const Mapping& root, SceneDraft& draft) {
  Scene& scene = draft.scene;
  scene.home.assign(scene.independent.size(), 0.0);
  const NodePtr node = root.find("home");
  if (!node) return;
  std::vector<std::string> names;
  for (const auto& coordinate : scene.independent) names.push_back(coordinate.name);
  for (const auto& coordinate : scene.coordinates) names.push_back(coordinate.name);
  const Mapping entry(node, "home", names);
  const auto number = [&](const std::string& name, const Dimension& wanted) -> std::optional<double> {
    const NodePtr value = entry.find(name);
    if (!value) return std::nullopt;
    const Formula psi = draft.formula(*value, wanted, "the position of '" + name + "'", draft.fixed);
    if (!psi.is_constant())
      throw InputError("varying_number", value->place, "home depends on no parameter; expected a number");
    return psi.constant();
  };
  for (std::size_t i = 0; i < scene.independent.size(); ++i)
    scene.home[i] =
        number(scene.independent[i].name, scene.independent[i].linear ? kLength : kPure).value_or(0);
  const auto is_independent = [&](const std::string& name) {  // that transforms name themselves
    return std::any_of(scene.independent.begin(), scene.independent.end(),
                       [&](const auto& independent) { return independent.name == name; });
  };
  for (auto& coordinate : scene.coordinates) {
    if (coordinate.is_solved())
      coordinate.home = number(coordinate.name, coordinate.constraint.dimension).value_or(0);
    else if (const NodePtr value = is_independent(coordinate.name) ? nullptr : entry.find(coordinate.name))
      throw InputError("guess_beside_formula", value->place,
                       "the coordinate '" + coordinate.name +
                           "' follows from its formula and takes no guess; expected motors, free "
                           "coordinates, and those that are solved from closures");
  }
}

void read_singularities(const Mapping& root, SceneDraft& draft) {
  const Node* node = section(root, "singularities");
  if (!node) return;
  for (const auto& entry : node->entries)
    draft.scene.singularities.push_back(
        {entry.key,
         draft.formula(*entry.value, kOpen, "a formula that is zero at the singularity", draft.moving),
         entry.place});
}

}  // namespace

const Keys& end_effector_keys() {
  static const Keys keys{"the end effector",
                         {{"frame", form::text(), kRequired},
                          {"point", form::numbers()},
                          {"axes", form::list(form::word(prescribed_words()))},
                          {"direction", form::one_of({form::word({"x", "y", "z"}), form::numbers()})}}};
  return keys;
}

const Keys& scene_keys() {
  using namespace form;
  const auto of_kinds = [] { return named(word({"rotary", "linear"})); };
  const auto name = [&] { return one_of({text(), of_kinds()}); };
  const auto names = [&] { return one_of({list(name()), of_kinds()}); };
  static const Keys keys{
      "the scene",
      {{"name", text()},
       {"constants", named(number())},
       {"parameters", named(number())},
       {"motors", names()},
       {"free", names()},
       {"coordinates", list(name())},
       {"constraints", named(number())},
       {"closures", list(one_of({mapping(coincide_keys), mapping(distance_keys), mapping(parallel_keys),
                                 mapping(align_keys), mapping(zero_keys)}))},
       {"convention", word({"standard", "modified"})},
       {"transforms", list(one_of({mapping(transform_keys), mapping(pose_keys)})), kRequired},
       {"bodies", list(mapping(body_keys)), kRequired},
       {"loads", list(one_of({mapping(load_keys), mapping(coordinate_load_keys), mapping(along_load_keys),
                              mapping(between_load_keys)}))},
       {"gravity", numbers()},
       {"end_effector", mapping(end_effector_keys)},
       {"home", named(number())},
       {"singularities", named(number())},
       {"solids", list(one_of({mapping(box_keys), mapping(sphere_keys), mapping(round_keys)}))}}};
  return keys;
}

Scene read_scene(const NodePtr& document) {
  const Mapping root = read_mapping(document, scene_keys());
  SceneDraft draft;
  read_name(root, draft.scene);
  read_parameters(root, draft);
  read_constants(root, draft);
  read_independent(root, draft);
  read_constraints(root, draft);
  read_transforms(root, draft);
  read_bodies(root, draft);
  read_loads(root, draft);
  read_closures(root, draft);
  draft.scene.gravity = draft.vector(root.find("gravity"), kAcceleration, "gravity", draft.fixed);
  read_end_effector(root, draft);
  read_home(root, draft);
  read_singularities(root, draft);
  read_solids(root, draft);
  return std::move(draft.scene);
}

}  // namespace mixloop
