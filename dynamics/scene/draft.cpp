// SPDX-License-Identifier: MIT
#include "dynamics/scene/draft.hpp"

#include <fmt/format.h>

#include "notation/nearest.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"

namespace mixloop {

Formula SceneDraft::formula(const Node& node, const Dimension& wanted, const std::string& what,
                            const Scope& scope) {
  constexpr std::size_t kMostTerms = 100'000;
  Formula result = parse_formula(node, what, scope);
  require_dimension(result, wanted, what);
  settle_parameter(result, wanted);
  terms += result.nodes.size();
  if (terms > kMostTerms)
    throw InputError(
        "too_large", node.place,
        fmt::format("the scene's formulas have more than {} terms, constants written out", kMostTerms));
  return result;
}

void SceneDraft::settle_parameter(const Formula& formula, const Dimension& wanted) {
  const Formula::Node& node = formula.nodes.front();
  if (wanted.open || formula.nodes.size() != 1 || node.op != Formula::Operator::symbol) return;
  const int index = node.symbol - Symbols::kParameter0;
  if (!bare_parameters.contains(index)) return;
  Dimension& dimension = scene.parameters[static_cast<std::size_t>(index)].dimension;
  const bool differs = !dimension.open && !dimension.same_powers(wanted);
  dimension = differs ? kOpen : wanted;
  if (differs) bare_parameters.erase(index);
}

std::array<Formula, 3> SceneDraft::vector(const NodePtr& node, const Dimension& wanted,
                                          const std::string& what, const Scope& scope) {
  if (!node) return {constant_formula(0, wanted), constant_formula(0, wanted), constant_formula(0, wanted)};
  if (node->kind != Node::Kind::sequence || node->items.size() != 3)
    throw InputError("wrong_size", node->place,
                     "found " + describe(*node) + "; expected " + what + " as [x, y, z]");
  const auto part = [&](std::size_t i) { return formula(*node->items[i], wanted, what, scope); };
  return {part(0), part(1), part(2)};
}

std::array<double, 3> SceneDraft::axis(const NodePtr& node, const std::string& what) {
  std::array<double, 3> numbers{};
  if (node->kind == Node::Kind::scalar) {
    numbers[word_of(*node, {"x", "y", "z"}, what)] = 1;
    return numbers;
  }
  const auto parts = vector(node, kPure, what + " x, y, z, or a vector", fixed);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!parts[i].is_constant())
      throw InputError("varying_number", parts[i].place, "an axis depends on no parameter; expected numbers");
    numbers[i] = parts[i].constant();
  }
  if (numbers == std::array<double, 3>{})
    throw InputError("out_of_range", node->place, what + " is [0, 0, 0]; expected a direction");
  return numbers;
}

int SceneDraft::frame(const Mapping& entry) const { return frame_named(*entry.at("frame"), entry.what()); }

int SceneDraft::frame_named(const Node& node, const std::string& what) const {
  const std::string& name = text_of(node, "a frame's name");
  const auto found = frame_index.find(name);
  if (found != frame_index.end()) return found->second;
  std::vector<std::string> names = scene.frames;
  std::erase(names, "");
  throw InputError("broken_path", node.place,
                   what + " sits on the frame " + in_quotes(name) + ", which no transform makes" +
                       suggestion(name, names));
}

int SceneDraft::as_coordinate(int independent) {
  const auto& psi = scene.independent[static_cast<std::size_t>(independent)];
  for (int j = 0; j < scene.m(); ++j)  // names are unique: a coordinate of this name is that one
    if (scene.coordinates[static_cast<std::size_t>(j)].name == psi.name) return j;
  Formula equal = constant_formula(0, psi.linear ? kLength : kPure);
  equal.nodes.front() = {.op = Formula::Operator::symbol, .symbol = Symbols(scene).psi0 + independent};
  scene.evaluation_order.push_back(scene.m());
  scene.steps.push_back({.coordinate = scene.m()});
  scene.coordinates.push_back({.name = psi.name, .constraint = std::move(equal)});
  return scene.m() - 1;
}

int SceneDraft::coordinate(const Mapping& entry) const {
  const NodePtr node = entry.at("coordinate");
  const std::string& name = text_of(*node, "a coordinate's name");
  const auto found = coordinate_index.find(name);
  if (found != coordinate_index.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& coordinate : scene.coordinates) names.push_back(coordinate.name);
  throw InputError(
      "undefined_symbol", node->place,
      entry.what() + " acts on " + in_quotes(name) + ", which is no coordinate" + suggestion(name, names));
}

const Node* section(const Mapping& root, const char* key) {
  const NodePtr node = root.find(key);
  if (!node || node->kind == Node::Kind::empty) return nullptr;
  if (node->kind != Node::Kind::mapping)
    throw InputError("wrong_kind", node->place,
                     "found " + describe(*node) + "; expected " + key + " as name: value");
  return node.get();  // the document keeps it
}

bool has_closures(const Mapping& root) {
  const NodePtr node = root.find("closures");
  return node && node->kind != Node::Kind::empty;
}

std::vector<NodePtr> items_within(const NodePtr& node, std::size_t least, std::size_t most,
                                  const std::string& what) {
  auto items = items_of(node, what);
  if (items.size() < least || items.size() > most)
    throw InputError(
        "wrong_size", node->place,
        fmt::format("found {}; expected {}, from {} to {} of them", describe(*node), what, least, most));
  return items;
}

void check_symbol_name(const std::string& name, const Place& place) {
  check_name(name, place);
  if (name == "t") throw InputError("invalid_name", place, "'t' is the time; choose another name");
}

}  // namespace mixloop
