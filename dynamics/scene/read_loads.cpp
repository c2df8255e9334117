// SPDX-License-Identifier: MIT
// What acts on the mechanism beside gravity and the motors.
#include <fmt/format.h>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostLoads = 1000;

Scene::Load load_at_point(const NodePtr& item, SceneDraft& draft, const Scope& timed) {
  const Mapping entry = read_mapping(item, load_keys());
  Scene::Load load;
  load.frame = draft.frame(entry);
  load.point = draft.vector(entry.find("point"), kLength, "the point", draft.fixed);
  load.force = draft.vector(entry.find("force"), kForce, "the force", timed);
  load.moment = draft.vector(entry.find("moment"), kMoment, "the moment", timed);
  return load;
}

/// Along an angle, or along a length where it `slides`; what isn't given is zero.
Scene::SpringDamper law_in(const Mapping& entry, bool slides, SceneDraft& draft) {
  const Dimension position = slides ? kLength : kPure, effort = slides ? kForce : kMoment;
  const auto number = [&](const char* key, const Dimension& wanted) {
    const NodePtr node = entry.find(key);
    return node ? draft.formula(*node, wanted, fmt::format("the {}", key), draft.fixed)
                : constant_formula(0, wanted, entry.node().place);
  };
  Scene::SpringDamper law;
  law.stiffness = number("stiffness", effort / position);
  law.rest = number("rest", position);
  law.damping = number("damping", effort / position * kTime);
  return law;
}

void require_a_law(const Mapping& entry) {
  if (!entry.has("stiffness") && !entry.has("damping"))
    throw InputError("missing_key", entry.node().place,
                     entry.what() + " lacks both 'stiffness' and 'damping'; expected one of them or both");
}

Scene::CoordinateLoad load_at_coordinate(const NodePtr& item, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, coordinate_load_keys());
  Scene::CoordinateLoad load;
  load.coordinate = draft.coordinate(entry);
  const Formula& constraint = draft.scene.coordinates[static_cast<std::size_t>(load.coordinate)].constraint;
  Scene::SpringDamper law = law_in(entry, constraint.dimension.same_powers(kLength), draft);
  load.stiffness = std::move(law.stiffness);
  load.rest = std::move(law.rest);
  load.damping = std::move(law.damping);
  return load;
}

Scene::AlongLoad load_along(const NodePtr& item, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, along_load_keys());
  require_a_law(entry);
  Scene::AlongLoad load;
  load.along = draft.formula(*entry.at("along"), kOpen, "a formula of coordinates", draft.moving);
  const Dimension& dimension = load.along.dimension;
  if (!dimension.pure() && !dimension.same_powers(kLength))
    throw InputError("wrong_dimension", load.along.place,
                     "what a load acts along is " + to_string(dimension) + "; expected an angle or a length");
  const Symbols symbols(draft.scene);
  if (!depends_on(load.along, [&](int symbol) { return symbol >= symbols.psi0; }))
    throw InputError("undefined_symbol", load.along.place,
                     "what a load acts along names no coordinate; expected a formula of coordinates");
  load.law = law_in(entry, dimension.same_powers(kLength), draft);
  return load;
}

const Keys& load_end_keys() {
  static const Keys keys{"an end of a load",
                         {{"frame", form::text(), kRequired}, {"point", form::numbers()}}};
  return keys;
}

/// Whether a joint lies between two frames.
bool may_move(const Scene& scene, int one, int other) {
  while (one != other) {
    int& outer = one > other ? one : other;  // parents come first
    const auto& transform = scene.transforms[static_cast<std::size_t>(outer - 1)];
    if (transform.coordinate) return true;
    outer = transform.parent;
  }
  return false;
}

Scene::BetweenLoad load_between(const NodePtr& item, SceneDraft& draft) {
  const Mapping entry = read_mapping(item, between_load_keys());
  require_a_law(entry);
  Scene::BetweenLoad load;
  const NodePtr between = entry.at("between");
  const auto ends = items_within(between, 2, 2, "the two ends of a load");
  for (std::size_t i = 0; i < 2; ++i) {
    const Mapping end = read_mapping(ends[i], load_end_keys());
    load.ends[i].frame = draft.frame(end);
    load.ends[i].point = draft.vector(end.find("point"), kLength, "the point", draft.fixed);
  }
  if (!may_move(draft.scene, load.ends[0].frame, load.ends[1].frame))
    throw InputError(
        "out_of_range", between->place,
        "a load between two points of one rigid body moves nothing; expected frames with a joint "
        "between them");
  if (entry.has("stiffness") && !entry.has("rest"))
    throw InputError("missing_key", entry.node().place,
                     "a stiffness between two points lacks the key 'rest'; expected the length at which it "
                     "pulls nothing");
  load.law = law_in(entry, true, draft);
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

const Keys& along_load_keys() {
  static const Keys keys{"a load along a formula",
                         {{"along", form::number(), kRequired},
                          {"stiffness", form::number()},
                          {"rest", form::number()},
                          {"damping", form::number()}}};
  return keys;
}

const Keys& between_load_keys() {
  static const Keys keys{"a load between two points",
                         {{"between", form::list(form::mapping(load_end_keys)), kRequired},
                          {"stiffness", form::number()},
                          {"rest", form::number()},
                          {"damping", form::number()}}};
  return keys;
}

void read_loads(const Mapping& root, SceneDraft& draft) {
  const NodePtr node = root.find("loads");
  if (!node || node->kind == Node::Kind::empty) return;
  Scope timed = draft.fixed;
  timed.define_symbol("t", Symbols::kTime, kTime, {});
  Scene& scene = draft.scene;
  for (const auto& item : items_within(node, 0, kMostLoads, "the loads")) {
    if (find_entry(*item, "coordinate"))
      scene.coordinate_loads.push_back(load_at_coordinate(item, draft));
    else if (find_entry(*item, "along"))
      scene.along_loads.push_back(load_along(item, draft));
    else if (find_entry(*item, "between"))
      scene.between_loads.push_back(load_between(item, draft));
    else
      scene.loads.push_back(load_at_point(item, draft, timed));
  }
}

}  // namespace mixloop
