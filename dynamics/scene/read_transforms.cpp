// SPDX-License-Identifier: MIT
// Frames are made by transforms; they are put in order so that parents come first.
#include <fmt/format.h>

#include <algorithm>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/read_pose.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "dynamics/scene/screws.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostTransforms = 1000;

/// Independent coordinates that a number names directly, as coordinates that are equal to them.
void name_coordinates(Formula& formula, SceneDraft& draft) {
  const Symbols symbols(draft.scene);
  for (Formula::Node& node : formula.nodes)
    if (node.op == Formula::Operator::symbol && symbols.is_psi(node.symbol))
      node.symbol = symbols.q0 + draft.as_coordinate(node.symbol - symbols.psi0);
}

/// Which coordinate varies the transform: at most one, in theta or s, affinely.
void find_coordinate(const Scene& scene, Scene::Transform& transform) {
  const Symbols symbols(scene);
  for (const auto* part : {&transform.theta, &transform.s, &transform.a, &transform.alpha}) {
    if (depends_on(*part, [&](int symbol) { return symbol == Symbols::kTime; }))
      throw InputError("varying_number", part->place,
                       "a transform varies by coordinates only, not by time directly; name a coordinate with "
                       "that constraint");
    for (int j = 0; j < scene.m(); ++j) {
      const int power = degree(*part, [&](int symbol) { return symbol == symbols.q0 + j; });
      if (power == 0) continue;
      const std::string& name = scene.coordinates[static_cast<std::size_t>(j)].name;
      if (part == &transform.a || part == &transform.alpha)
        throw InputError("varying_number", part->place,
                         "a and alpha are constant; '" + name + "' may vary theta or s");
      if (power > 1)
        throw InputError("varying_number", part->place,
                         "not affine in '" + name + "'; put the formula into its constraint");
      if (transform.coordinate)
        throw InputError("varying_number", part->place,
                         "a second varying coordinate '" + name + "' in one transform; expected at most one");
      transform.coordinate = j;
      transform.prismatic = part == &transform.s;
    }
  }
}

/// Denavit and Hartenberg's numbers.
std::vector<Scene::Transform> read_numbers(const Mapping& entry, bool modified, SceneDraft& draft) {
  Scene::Transform transform;
  transform.place = entry.node().place;
  const auto part = [&](const char* key, const Dimension& wanted) {
    const NodePtr node = entry.find(key);
    return node ? draft.formula(*node, wanted, key, draft.moving)
                : constant_formula(0, wanted, entry.node().place);
  };
  transform.theta = part("theta", kPure);
  transform.s = part("s", kLength);
  transform.a = part("a", kLength);
  transform.alpha = part("alpha", kPure);
  if (!modified) return {transform};
  Scene::Transform checked = transform;  // while a and alpha are still to be told by their names
  for (auto* number : {&checked.theta, &checked.s, &checked.a, &checked.alpha})
    name_coordinates(*number, draft);
  find_coordinate(draft.scene, checked);
  // Craig, Introduction to Robotics (3.6): Rx(alpha) Tx(a) Rz(theta) Tz(s)
  Screws screws(transform.place);
  screws.turn_x(transform.alpha);
  screws.move_x(transform.a);
  screws.turn_z(transform.theta);
  screws.move_z(transform.s);
  return screws.transforms();
}

/// What an entry takes more than one transform for goes by frames without a name.
void add_transform(const Mapping& entry, bool modified, SceneDraft& draft) {
  int parent = draft.frame_index.at(entry.at("from")->text);
  auto row = is_pose(entry) ? read_pose(entry, draft) : read_numbers(entry, modified, draft);
  for (Scene::Transform& transform : row) {
    transform.parent = parent;
    for (auto* number : {&transform.theta, &transform.s, &transform.a, &transform.alpha})
      name_coordinates(*number, draft);
    find_coordinate(draft.scene, transform);
    parent = static_cast<int>(draft.scene.frames.size());
    draft.scene.frames.emplace_back();
    draft.scene.transforms.push_back(std::move(transform));
  }
  draft.scene.frames.back() = entry.at("to")->text;
  draft.frame_index[draft.scene.frames.back()] = parent;
}

/// Whether tables of Denavit and Hartenberg's numbers are in Craig's order.
bool is_modified(const Mapping& root) {
  const NodePtr node = root.find("convention");
  return node && word_of(*node, words_of(scene_keys(), "convention"), "the convention") == 1;
}

/// An entry, as one that may have the keys of either kind.
Mapping entry_of(const NodePtr& item) {
  Keys both = transform_keys();
  for (const Key& key : pose_keys().all)
    if (!key.required) both.all.push_back(key);
  return read_mapping(item, both);
}

}  // namespace

const Keys& transform_keys() {
  static const Keys keys{"a transform",
                         {{"from", form::text(), kRequired},
                          {"to", form::text(), kRequired},
                          {"theta", form::number()},
                          {"s", form::number()},
                          {"a", form::number()},
                          {"alpha", form::number()}}};
  return keys;
}

void read_transforms(const Mapping& root, SceneDraft& draft) {
  std::vector<Mapping> pending;
  std::map<std::string, int> lines;
  for (const auto& item : items_within(root.at("transforms"), 1, kMostTransforms, "the transforms")) {
    pending.push_back(entry_of(item));
    text_of(*pending.back().at("from"), "a frame's name");
    const NodePtr to = pending.back().at("to");
    const std::string& name = text_of(*to, "a frame's name");
    if (name.empty()) throw InputError("invalid_name", to->place, "a frame without a name; expected one");
    if (name == "0") throw InputError("doubly_defined", to->place, "a transform to the ground frame '0'");
    if (const auto [known, is_new] = lines.emplace(name, to->place.line); !is_new)
      throw InputError("doubly_defined", to->place,
                       fmt::format("two transforms make the frame {}, the first at line {}", in_quotes(name),
                                   known->second));
  }
  const bool modified = is_modified(root);
  draft.scene.frames = {"0"};
  draft.frame_index["0"] = 0;
  while (!pending.empty()) {
    const auto next = std::find_if(pending.begin(), pending.end(), [&](const Mapping& entry) {
      return draft.frame_index.contains(entry.at("from")->text);
    });
    if (next == pending.end()) {
      const NodePtr from = pending.front().at("from");
      throw InputError(
          "broken_path", from->place,
          "the frame " + in_quotes(from->text) + " has no path to the ground frame '0'" +
              (lines.contains(from->text) ? ": its transforms form a circle" : ": no transform makes it"));
    }
    add_transform(*next, modified, draft);
    pending.erase(next);
  }
}

}  // namespace mixloop
