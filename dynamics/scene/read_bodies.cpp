// SPDX-License-Identifier: MIT
// What has mass.
#include <fmt/format.h>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostBodies = 1000;

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

}  // namespace

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

}  // namespace mixloop
