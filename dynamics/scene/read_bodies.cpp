// SPDX-License-Identifier: MIT
// What has mass, and what acts on it.
#include <fmt/format.h>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostBodies = 1000;
constexpr std::size_t kMostLoads = 1000;

/// In the order of Scene::Body::inertia.
const Keys& inertia_keys() {
  static const Keys keys{"an inertia",
                         {{"xx", form::number(), kRequired},
                          {"yy", form::number(), kRequired},
                          {"zz", form::number(), kRequired},
                          {"xy", form::number()},
                          {"xz", form::number()},
                          {"yz", form::number()}}};
  return keys;
}

void read_inertia(const NodePtr& node, Scene::Body& body, SceneDraft& draft) {
  const Mapping entry = read_mapping(node, inertia_keys());
  for (std::size_t i = 0; i < body.inertia.size(); ++i) {
    const auto& [name, form, required] = inertia_keys().all[i];
    const NodePtr element = required ? entry.at(name) : entry.find(name);
    if (element) body.inertia[i] = draft.formula(*element, kInertia, "I_" + name, draft.fixed);
  }
}

Scene::Load load_at_point(const NodePtr& item, SceneDraft& draft, const Scope& timed) {
  const Mapping entry = read_mapping(item, load_keys());
  Scene::Load load;
  load.frame = draft.frame(entry);
  load.point = draft.vector(entry.find("point"), kLength, "the point", draft.fixed);
  load.force = draft.vector(entry.find("force"), kForce, "the force", timed);
  load.moment = draft.vector(entry.find("moment"), kMoment, "the moment", timed);
  return load;
}

Scene::CoordinateLoad load_at_coordinate(const NodePtr& item, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, coordinate_load_keys());
  Scene::CoordinateLoad load;
  load.coordinate = draft.coordinate(entry);
  const Formula& constraint = draft.scene.coordinates[static_cast<std::size_t>(load.coordinate)].constraint;
  const bool slides = constraint.dimension.same_powers(kLength);
  const Dimension position = slides ? kLength : kPure, effort = slides ? kForce : kMoment;
  const auto number = [&](const char* key, const Dimension& wanted) {
    const NodePtr node = entry.find(key);
    return node ? draft.formula(*node, wanted, fmt::format("the {}", key), draft.fixed)
                : constant_formula(0, wanted, item->place);
  };
  load.stiffness = number("stiffness", effort / position);
  load.rest = number("rest", position);
  load.damping = number("damping", effort / position * kTime);
  return load;
}

}  // namespace

const Keys& load_keys() {
  static const Keys keys{"a load",
                         {{"frame", form::text(), kRequired},
                          {"point", form::numbers()},
                          {"force", form::numbers()},
                          {"moment", form::numbers()}}};
  return keys;
}

const Keys& coordinate_load_keys() {
  static const Keys keys{"a load at a coordinate",
                         {{"coordinate", form::text(), kRequired},
                          {"stiffness", form::number()},
                          {"rest", form::number()},
                          {"damping", form::number()}}};
  return keys;
}

const Keys& body_keys() {
  static const Keys keys{"a body",
                         {{"name", form::text()},
                          {"frame", form::text(), kRequired},
                          {"mass", form::number(), kRequired},
                          {"center_of_mass", form::numbers()},
                          {"inertia", form::mapping(inertia_keys)}}};
  return keys;
}

void read_bodies(const Mapping& root, SceneDraft& draft) {
  for (const auto& item : items_within(root.at("bodies"), 1, kMostBodies, "the bodies")) {
    Scene::Body body;
    const Mapping entry = read_mapping(item, body_keys());
    body.place = item->place;
    body.frame = draft.frame(entry);
    const NodePtr name = entry.find("name");
    body.name =
        name ? text_of(*name, "a body's name") : fmt::format("body {}", draft.scene.bodies.size() + 1);
    body.mass = draft.formula(*entry.at("mass"), kMass, "the mass", draft.fixed);
    body.center_of_mass =
        draft.vector(entry.find("center_of_mass"), kLength, "the centre of mass", draft.fixed);
    body.inertia.fill(constant_formula(0, kInertia, item->place));
    if (const NodePtr tensor = entry.find("inertia")) read_inertia(tensor, body, draft);
    draft.scene.bodies.push_back(std::move(body));
  }
}

void read_loads(const Mapping& root, SceneDraft& draft) {
  const NodePtr node = root.find("loads");
  if (!node || node->kind == Node::Kind::empty) return;
  Scope timed = draft.fixed;
  timed.define_symbol("t", Symbols::kTime, kTime, {});
  for (const auto& item : items_within(node, 0, kMostLoads, "the loads")) {
    if (find_entry(*item, "coordinate"))
      draft.scene.coordinate_loads.push_back(load_at_coordinate(item, draft));
    else
      draft.scene.loads.push_back(load_at_point(item, draft, timed));
  }
}

}  // namespace mixloop
