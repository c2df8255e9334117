// SPDX-License-Identifier: MIT
// What formulas may refer to: parameters, constants, motors, and coordinates with their constraints.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "dynamics/scene/definitions.hpp"
#include "dynamics/scene/draft.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostParameters = 256;
constexpr std::size_t kMostIndependent = 64;
constexpr std::size_t kMostCoordinates = 256;

const Node& constraints_of(const Mapping& root) {
  static const Node none{.kind = Node::Kind::mapping};
  // Where chains close, none need be written.
  const NodePtr node = has_closures(root) ? root.find("constraints") : root.at("constraints");
  if (!node) return none;
  if (node->kind != Node::Kind::mapping)
    throw InputError("wrong_kind", node->place,
                     "found " + describe(*node) + "; expected constraints as coordinate: equation");
  return *node;
}

/// Whether the transforms let a coordinate turn a frame (a pure number) or shift it (a length); as far as its
/// name stands in them.
std::optional<Dimension> dimension_in_transforms(const Mapping& root, const std::string& name) {
  const NodePtr transforms = root.find("transforms");
  if (!transforms || transforms->kind != Node::Kind::sequence) return std::nullopt;
  for (const auto& item : transforms->items) {
    if (item->kind != Node::Kind::mapping) continue;
    for (const auto& [key, dimension] : {std::pair{"theta", kPure}, std::pair{"revolute", kPure},
                                         std::pair{"s", kLength}, std::pair{"prismatic", kLength}}) {
      const NodePtr value = find_entry(*item, key);
      if (!value || value->kind != Node::Kind::scalar) continue;
      const auto names = names_in(value->text);
      if (std::find(names.begin(), names.end(), name) != names.end()) return dimension;
    }
  }
  return std::nullopt;
}

/// A coordinate as its list has it: its name, or {name: rotary | linear}.
struct Listed {
  std::string name;
  Place place;
  std::optional<Dimension> dimension;
};

/// `what`: one of those that are listed.
Listed of_kind(const Node::Entry& entry, const std::string& what) {
  const bool linear = word_of(*entry.value, {"rotary", "linear"}, "the " + what + "'s kind") == 1;
  return {entry.key, entry.place, linear ? kLength : kPure};
}

Listed listed(const Node& item, const std::string& what) {
  if (item.kind != Node::Kind::mapping)
    return {text_of(item, "a " + what + "'s name"), item.place, std::nullopt};
  if (item.entries.size() != 1)
    throw InputError("wrong_size", item.place,
                     "found " + describe(item) + "; expected a " + what + " as name: rotary or name: linear");
  return of_kind(item.entries.front(), what);
}

/// A list of names, each alone or {name: kind}, or a mapping of all.
std::vector<Listed> listed_in(const NodePtr& node, std::size_t most, const char* what) {
  std::vector<Listed> all;
  if (node->kind != Node::Kind::mapping) {
    for (const auto& item : items_within(node, 1, most, fmt::format("the {}s' names", what)))
      all.push_back(listed(*item, what));
    return all;
  }
  if (node->entries.empty() || node->entries.size() > most)
    throw InputError("wrong_size", node->place,
                     fmt::format("found {} {}s; expected from 1 to {}", node->entries.size(), what, most));
  for (const auto& entry : node->entries) all.push_back(of_kind(entry, what));
  return all;
}

/// The motors, or the free coordinates behind them.
void add_independent(const NodePtr& node, bool driven, SceneDraft& draft) {
  Scene& scene = draft.scene;
  const std::size_t most = kMostIndependent - scene.independent.size();
  for (const Listed& said : listed_in(node, most, driven ? "motor" : "free coordinate")) {
    check_symbol_name(said.name, said.place);
    const Dimension dimension = said.dimension.value_or(kPure);
    draft.moving.define_symbol(said.name, Symbols(scene).psi0 + scene.n(), dimension, said.place);
    scene.independent.push_back({said.name, dimension.same_powers(kLength), driven});
  }
}

/// One without a formula: what it is, by its own word or the transform that it varies.
Scene::Coordinate solved_coordinate(const Listed& said, const Mapping& root) {
  const auto dimension = said.dimension ? said.dimension : dimension_in_transforms(root, said.name);
  if (!has_closures(root))
    throw InputError("missing_constraint", said.place,
                     "no constraint gives the coordinate '" + said.name + "'; expected an entry '" +
                         said.name + ": ...' under constraints, or closures that it follows from");
  if (!dimension)
    throw InputError("missing_constraint", said.place,
                     "no constraint gives the coordinate '" + said.name +
                         "' and no transform varies by it, so that nothing says what it is; expected {" +
                         said.name + ": rotary} or {" + said.name + ": linear}");
  return {.name = said.name, .constraint = {.dimension = *dimension}, .place = said.place};
}

void list_coordinates(const NodePtr& list, const Node& constraints, const Mapping& root, SceneDraft& draft) {
  for (const auto& item : items_within(list, 1, kMostCoordinates, "the coordinates' names")) {
    const Listed said = listed(*item, "coordinate");
    check_symbol_name(said.name, said.place);
    if (!draft.coordinate_index.emplace(said.name, draft.scene.m()).second)
      throw InputError("doubly_defined", said.place, "the coordinate '" + said.name + "' is listed twice");
    if (find_entry(constraints, said.name))
      draft.scene.coordinates.push_back({.name = said.name, .place = said.place});
    else
      draft.scene.coordinates.push_back(solved_coordinate(said, root));
  }
}

void refuse_other_constraints(const Node& constraints, const SceneDraft& draft) {
  for (const auto& entry : constraints.entries) {
    if (draft.coordinate_index.contains(entry.key)) continue;
    std::vector<std::string> names;
    for (const auto& coordinate : draft.scene.coordinates) names.push_back(coordinate.name);
    throw InputError("undefined_symbol", entry.place,
                     "a constraint for " + in_quotes(entry.key) + ", which is no coordinate" +
                         suggestion(entry.key, names));
  }
}

}  // namespace

void read_parameters(const Mapping& root, SceneDraft& draft) {
  const Node* node = section(root, "parameters");
  if (!node) return;
  if (node->entries.size() > kMostParameters)
    throw InputError(
        "wrong_size", node->place,
        fmt::format("found {} parameters; expected {} at most", node->entries.size(), kMostParameters));
  const Scope no_names;
  for (const auto& entry : node->entries) {
    check_symbol_name(entry.key, entry.place);
    const Formula value = draft.formula(*entry.value, kOpen, "a parameter's default", no_names);
    draft.fixed.define_symbol(entry.key,
                              Symbols::kParameter0 + static_cast<int>(draft.scene.parameters.size()),
                              value.dimension, entry.place);
    if (value.dimension.open) draft.bare_parameters.insert(static_cast<int>(draft.scene.parameters.size()));
    draft.scene.parameters.push_back({entry.key, value.dimension, value.constant(), entry.place});
  }
}

void read_constants(const Mapping& root, SceneDraft& draft) {
  const Node* node = section(root, "constants");
  if (!node) return;
  for (const auto& entry : node->entries) check_symbol_name(entry.key, entry.place);
  define_in_order(*node, "constants", [&](const Node::Entry& entry) {
    draft.fixed.define_formula(
        entry.key, draft.formula(*entry.value, kOpen, "a constant's value", draft.fixed), entry.place);
  });
}

void read_independent(const Mapping& root, SceneDraft& draft) {
  draft.moving = draft.fixed;
  draft.moving.define_symbol("t", Symbols::kTime, kTime, {});
  const NodePtr motors = root.find("motors"), free = root.find("free");
  if (!motors && !free)
    throw InputError(
        "missing_key", root.node().place,
        "the scene has neither 'motors' nor 'free' coordinates, so that nothing moves; expected one of "
        "them, or both");
  if (motors) add_independent(motors, true, draft);
  if (free) add_independent(free, false, draft);
}

void read_constraints(const Mapping& root, SceneDraft& draft) {
  if (!root.has("coordinates") && !root.has("constraints")) return;  // transforms may name motors themselves
  const Node& constraints = constraints_of(root);
  list_coordinates(root.at("coordinates"), constraints, root, draft);
  refuse_other_constraints(constraints, draft);
  const Symbols symbols(draft.scene);
  for (int j = 0; j < draft.scene.m(); ++j) {
    const auto& coordinate = draft.scene.coordinates[static_cast<std::size_t>(j)];
    if (!find_entry(constraints, coordinate.name))
      draft.moving.define_symbol(coordinate.name, symbols.q0 + j, coordinate.constraint.dimension,
                                 coordinate.place);
  }
  define_in_order(constraints, "coordinates", [&](const Node::Entry& entry) {
    const int index = draft.coordinate_index.at(entry.key);
    Formula equation =
        draft.formula(*entry.value, kOpen, "an equation for '" + entry.key + "'", draft.moving);
    const Dimension dimension = equation.dimension.open ? kPure : equation.dimension;
    if (!dimension.pure() && !dimension.same_powers(kLength))
      throw InputError("wrong_dimension", equation.place,
                       "the coordinate '" + entry.key + "' is " + to_string(dimension) +
                           "; expected an angle or a length");
    draft.scene.coordinates[static_cast<std::size_t>(index)].constraint = std::move(equation);
    draft.scene.evaluation_order.push_back(index);
    draft.scene.steps.push_back({.coordinate = index});
    draft.moving.define_symbol(entry.key, symbols.q0 + index, dimension, entry.place);
  });
}

}  // namespace mixloop
