// SPDX-License-Identifier: MIT
// What a viewer draws.
#include <fmt/format.h>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostSolids = 1000;

using Triple = std::array<double, 3>;

double constant(const Formula& formula, const std::string& what, const Place& place) {
  if (formula.is_constant()) return formula.constant();
  throw InputError("varying_number", place, what + " depends on no parameter; expected a number");
}

double positive(double value, const std::string& what, const Place& place) {
  if (value > 0) return value;
  throw InputError("out_of_range", place, fmt::format("{} is {} m; expected more than 0", what, value));
}

double radius_in(const Mapping& entry, SceneDraft& draft) {
  const NodePtr node = entry.at("radius");
  const std::string what = "the radius of " + entry.what();
  return positive(constant(draft.formula(*node, kLength, what, draft.fixed), what, node->place), what,
                  node->place);
}

/// Three lengths; the frame's origin where the key is absent.
Triple triple_in(const Mapping& entry, const char* key, SceneDraft& draft) {
  Triple numbers = {};
  const NodePtr node = entry.find(key);
  const std::string what = fmt::format("'{}' of {}", key, entry.what());
  if (!node) return numbers;
  const auto formulas = draft.vector(node, kLength, what, draft.fixed);
  for (std::size_t i = 0; i < 3; ++i) numbers[i] = constant(formulas[i], what, node->place);
  return numbers;
}

void read_box(const NodePtr& item, Scene::Solid& solid, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, box_keys());
  const Place& place = entry.at("size")->place;
  solid.size = triple_in(entry, "size", draft);
  for (const double edge : solid.size) positive(edge, "an edge of a box", place);
  solid.from = solid.to = triple_in(entry, "at", draft);
}

void read_sphere(const NodePtr& item, Scene::Solid& solid, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, sphere_keys());
  solid.radius = radius_in(entry, draft);
  solid.from = solid.to = triple_in(entry, "at", draft);
}

void read_round(const NodePtr& item, Scene::Solid& solid, SceneDraft& draft) {
  Keys keys = round_keys();
  keys.what = solid.shape == Scene::Solid::Shape::capsule ? "a capsule" : "a cylinder";
  const Mapping entry = read_mapping(item, keys);
  solid.radius = radius_in(entry, draft);
  solid.from = triple_in(entry, "from", draft);
  solid.to = triple_in(entry, "to", draft);
  if (solid.from == solid.to)
    throw InputError(
        "out_of_range", item->place,
        entry.what() + " goes from a place to the same place; expected 'from' and 'to' that differ");
}

Scene::Solid solid_in(const NodePtr& item, SceneDraft& draft) {
  using Shape = Scene::Solid::Shape;
  const Mapping entry(item, "a solid", {"frame", "shape", "size", "radius", "at", "from", "to"});
  Scene::Solid solid;
  solid.frame = draft.frame(entry);
  solid.shape = static_cast<Shape>(word_of(*entry.at("shape"),
                                           {Scene::Solid::kShapes.begin(), Scene::Solid::kShapes.end()},
                                           "the shape of a solid"));
  if (solid.shape == Shape::box)
    read_box(item, solid, draft);
  else if (solid.shape == Shape::sphere)
    read_sphere(item, solid, draft);
  else
    read_round(item, solid, draft);
  return solid;
}

}  // namespace

const Keys& box_keys() {
  static const Keys keys{"a box",
                         {{"frame", form::text(), kRequired},
                          {"shape", form::word({"box"}), kRequired},
                          {"size", form::numbers(), kRequired},
                          {"at", form::numbers()}}};
  return keys;
}

const Keys& sphere_keys() {
  static const Keys keys{"a sphere",
                         {{"frame", form::text(), kRequired},
                          {"shape", form::word({"sphere"}), kRequired},
                          {"radius", form::number(), kRequired},
                          {"at", form::numbers()}}};
  return keys;
}

const Keys& round_keys() {
  static const Keys keys{"a cylinder or a capsule",
                         {{"frame", form::text(), kRequired},
                          {"shape", form::word({"cylinder", "capsule"}), kRequired},
                          {"radius", form::number(), kRequired},
                          {"from", form::numbers()},
                          {"to", form::numbers()}}};
  return keys;
}

void read_solids(const Mapping& root, SceneDraft& draft) {
  const NodePtr node = root.find("solids");
  if (!node || node->kind == Node::Kind::empty) return;
  for (const auto& item : items_within(node, 0, kMostSolids, "the solids"))
    draft.scene.solids.push_back(solid_in(item, draft));
}

}  // namespace mixloop
