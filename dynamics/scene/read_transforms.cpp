// SPDX-License-Identifier: MIT
// Frames are made by transforms; they are put in order so that parents come first.
#include <fmt/format.h>

#include <algorithm>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostTransforms = 1000;

/// Which coordinate varies the transform: at most one, in theta or s, affinely.
void find_coordinate(const Scene& scene, Scene::Transform& transform) {
  const Symbols symbols(scene);
  for (const auto* part : {&transform.theta, &transform.s, &transform.a, &transform.alpha}) {
    if (depends_on(*part, [&](int symbol) { return symbol == Symbols::kTime || symbols.is_psi(symbol); }))
      throw InputError("varying_number", part->place,
                       "a transform varies by coordinates only, not by motors or time directly; name a "
                       "coordinate with that constraint");
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

void add_transform(const Mapping& entry, SceneDraft& draft) {
  Scene::Transform transform;
  transform.from = entry.at("from")->text;
  transform.to = entry.at("to")->text;
  transform.parent = draft.frame_index.at(transform.from);
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
  find_coordinate(draft.scene, transform);
  draft.frame_index[transform.to] = static_cast<int>(draft.scene.frames.size());
  draft.scene.frames.push_back(transform.to);
  draft.scene.transforms.push_back(std::move(transform));
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
    pending.push_back(read_mapping(item, transform_keys()));
    text_of(*pending.back().at("from"), "a frame's name");
    const NodePtr to = pending.back().at("to");
    const std::string& name = text_of(*to, "a frame's name");
    if (name == "0") throw InputError("doubly_defined", to->place, "a transform to the ground frame '0'");
    if (const auto [known, is_new] = lines.emplace(name, to->place.line); !is_new)
      throw InputError("doubly_defined", to->place,
                       fmt::format("two transforms make the frame {}, the first at line {}", in_quotes(name),
                                   known->second));
  }
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
    add_transform(*next, draft);
    pending.erase(next);
  }
}

}  // namespace mixloop
