// SPDX-License-Identifier: MIT
// Where chains close: what must hold between two frames, from which coordinates without a formula follow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/scene/draft.hpp"
#include "dynamics/scene/scene_keys.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

using Kind = Scene::Closure::Kind;

constexpr std::size_t kMostClosures = 256;

const Keys& point_keys() {
  static const Keys keys{"a closure's point",
                         {{"frame", form::text(), kRequired}, {"point", form::numbers()}}};
  return keys;
}

const Keys& axis_keys() {
  static const Keys keys{"a closure's axis",
                         {{"frame", form::text(), kRequired},
                          {"axis", form::one_of({form::word({"x", "y", "z"}), form::numbers()}), kRequired}}};
  return keys;
}

const Keys& keys_of(Kind kind) {
  switch (kind) {
    case Kind::coincide:
      return coincide_keys();
    case Kind::distance:
      return distance_keys();
    case Kind::parallel:
      return parallel_keys();
    case Kind::align:
      return align_keys();
    case Kind::zero:
      break;
  }
  return zero_keys();
}

Kind kind_of(const Node& item) {
  if (item.kind != Node::Kind::mapping)
    throw InputError("wrong_kind", item.place, "found " + describe(item) + "; expected a closure");
  std::optional<Kind> found;
  for (std::size_t i = 0; i < Scene::Closure::kKinds.size(); ++i) {
    if (!find_entry(item, Scene::Closure::kKinds[i])) continue;
    if (found)
      throw InputError(
          "wrong_kind", item.place,
          fmt::format("a closure that says both {} and {}; expected one of them",
                      Scene::Closure::kKinds[static_cast<std::size_t>(*found)], Scene::Closure::kKinds[i]));
    found = static_cast<Kind>(i);
  }
  if (!found)
    throw InputError("missing_key", item.place,
                     "a closure that doesn't say what holds; expected one of coincide, distance, parallel, "
                     "align and zero");
  return *found;
}

std::vector<NodePtr> pair_of(const NodePtr& node, const std::string& what) {
  return items_within(node, 2, 2, what);
}

void read_points(const NodePtr& pair, Scene::Closure& closure, SceneDraft& draft) {
  const auto items = pair_of(pair, "two points, each as {frame: ..., point: [x, y, z]}");
  for (std::size_t i = 0; i < 2; ++i) {
    const Mapping entry = read_mapping(items[i], point_keys());
    closure.frames[i] = draft.frame(entry);
    closure.vectors[i] = draft.vector(entry.find("point"), kLength, "the point", draft.fixed);
  }
}

void read_axes(const NodePtr& pair, Scene::Closure& closure, SceneDraft& draft) {
  const auto items = pair_of(pair, "two axes, each as {frame: ..., axis: z}");
  for (std::size_t i = 0; i < 2; ++i) {
    const Mapping entry = read_mapping(items[i], axis_keys());
    closure.frames[i] = draft.frame(entry);
    const NodePtr axis = entry.at("axis");
    auto& vector = closure.vectors[i];
    if (axis->kind == Node::Kind::scalar) {
      vector.fill(constant_formula(0, kPure, axis->place));
      vector[word_of(*axis, {"x", "y", "z"}, "an axis")] = constant_formula(1, kPure, axis->place);
    } else {
      vector = draft.vector(axis, kPure, "the axis", draft.fixed);
    }
    std::array<double, 3> size{};
    for (std::size_t k = 0; k < 3; ++k)
      size[k] = std::abs(evaluate<double>(vector[k], [&](int symbol) {
        return draft.scene.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)].value;
      }));
    if (!(std::max({size[0], size[1], size[2]}) > 0))
      throw InputError("out_of_range", axis->place,
                       "an axis of length 0; expected x, y, z or a vector that points somewhere");
    if (i == 0)
      closure.least_axis = static_cast<int>(std::min_element(size.begin(), size.end()) - size.begin());
  }
}

void read_coincide(const Mapping& entry, Scene::Closure& closure, SceneDraft& draft) {
  read_points(entry.at("coincide"), closure, draft);
  if (const NodePtr in = entry.find("in")) closure.in = draft.frame_named(*in, "a closure's axes");
  closure.axes = {0, 1, 2};
  const NodePtr axes = entry.find("axes");
  if (!axes) return;
  closure.axes.clear();
  for (const auto& item : items_within(axes, 1, 3, "axes out of x, y, z")) {
    const int axis = static_cast<int>(word_of(*item, {"x", "y", "z"}, "an axis"));
    if (std::find(closure.axes.begin(), closure.axes.end(), axis) != closure.axes.end())
      throw InputError("doubly_defined", item->place, "the axis '" + item->text + "' is given twice");
    closure.axes.push_back(axis);
  }
}

void read_align(const NodePtr& pair, Scene::Closure& closure, SceneDraft& draft) {
  const auto items = pair_of(pair, "two frames");
  for (std::size_t i = 0; i < 2; ++i) closure.frames[i] = draft.frame_named(*items[i], "a closure");
}

void read_zero(const Node& node, Scene::Closure& closure, SceneDraft& draft) {
  closure.value = draft.formula(node, kOpen, "what is zero", draft.moving);
  const Dimension& dimension = closure.value.dimension;
  if (!dimension.open && !dimension.pure() && !dimension.same_powers(kLength))
    throw InputError("wrong_dimension", closure.value.place,
                     "what is zero is " + to_string(dimension) + "; expected an angle or a length");
}

/// Names the coordinates that move one of the frames and not the other.
void refuse_within_one_body(const Scene& scene, const Scene::Closure& closure) {
  if (closure.kind == Kind::zero) return;
  const auto carrier = [&](int frame) {
    while (frame > 0 && !scene.transforms[static_cast<std::size_t>(frame - 1)].coordinate)
      frame = scene.transforms[static_cast<std::size_t>(frame - 1)].parent;
    return frame;
  };
  if (carrier(closure.frames[0]) != carrier(closure.frames[1])) return;
  throw InputError("within_one_body", closure.place,
                   fmt::format("the closure {} holds between the frames {} and {}, which nothing moves "
                               "against each other; expected frames of two bodies",
                               in_quotes(closure.name),
                               in_quotes(scene.frames[static_cast<std::size_t>(closure.frames[0])]),
                               in_quotes(scene.frames[static_cast<std::size_t>(closure.frames[1])])));
}

}  // namespace

const Keys& coincide_keys() {
  static const Keys keys{"a closure 'coincide'",
                         {{"name", form::text()},
                          {"coincide", form::list(form::mapping(point_keys)), kRequired},
                          {"axes", form::list(form::word({"x", "y", "z"}))},
                          {"in", form::text()}}};
  return keys;
}

const Keys& distance_keys() {
  static const Keys keys{"a closure 'distance'",
                         {{"name", form::text()},
                          {"distance", form::number(), kRequired},
                          {"between", form::list(form::mapping(point_keys)), kRequired}}};
  return keys;
}

const Keys& parallel_keys() {
  static const Keys keys{
      "a closure 'parallel'",
      {{"name", form::text()}, {"parallel", form::list(form::mapping(axis_keys)), kRequired}}};
  return keys;
}

const Keys& align_keys() {
  static const Keys keys{"a closure 'align'",
                         {{"name", form::text()}, {"align", form::list(form::text()), kRequired}}};
  return keys;
}

const Keys& zero_keys() {
  static const Keys keys{"a closure 'zero'", {{"name", form::text()}, {"zero", form::number(), kRequired}}};
  return keys;
}

void read_closures(const Mapping& root, SceneDraft& draft) {
  if (!has_closures(root)) return;
  for (const auto& item : items_within(root.at("closures"), 1, kMostClosures, "the closures")) {
    Scene::Closure closure;
    closure.kind = kind_of(*item);
    closure.place = item->place;
    const Mapping entry = read_mapping(item, keys_of(closure.kind));
    const NodePtr name = entry.find("name");
    closure.name = name ? text_of(*name, "a closure's name")
                        : fmt::format("closure {}", draft.scene.closures.size() + 1);
    for (const auto& known : draft.scene.closures)
      if (known.name == closure.name)
        throw InputError("doubly_defined", item->place,
                         "two closures with the name " + in_quotes(closure.name));
    switch (closure.kind) {
      case Kind::coincide:
        read_coincide(entry, closure, draft);
        break;
      case Kind::distance:
        closure.value = draft.formula(*entry.at("distance"), kLength, "the distance", draft.moving);
        read_points(entry.at("between"), closure, draft);
        break;
      case Kind::parallel:
        read_axes(entry.at("parallel"), closure, draft);
        break;
      case Kind::align:
        read_align(entry.at("align"), closure, draft);
        break;
      case Kind::zero:
        read_zero(*entry.at("zero"), closure, draft);
        break;
    }
    refuse_within_one_body(draft.scene, closure);
    draft.scene.closures.push_back(std::move(closure));
  }
}

}  // namespace mixloop
