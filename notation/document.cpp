// SPDX-License-Identifier: MIT
#include "notation/document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/look_alikes.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::empty:
      return "nothing";
    case Node::Kind::scalar:
      return in_quotes(node.text);
    case Node::Kind::sequence:
      return fmt::format("a list of {}", node.items.size());
    case Node::Kind::mapping:
      return "a mapping";
  }
  return "";
}

Place place_in(const Node& scalar, std::size_t offset) {
  Place place = scalar.place;
  std::size_t begin = 0;
  for (const auto& piece : scalar.pieces) {
    if (piece.offset > offset) break;
    place.line = piece.line;
    place.column = piece.column;
    begin = piece.offset;
  }
  if (place.column > 0) place.column += static_cast<int>(offset - begin);
  return place;
}

const std::string& text_of(const Node& node, const std::string& what) {
  if (node.kind != Node::Kind::scalar)
    throw InputError("wrong_kind", node.place, "found " + describe(node) + "; expected " + what);
  return node.text;
}

std::vector<NodePtr> items_of(const NodePtr& node, const std::string& what) {
  if (node->kind == Node::Kind::scalar) return {node};
  if (node->kind != Node::Kind::sequence)
    throw InputError("wrong_kind", node->place, "found " + describe(*node) + "; expected a list: " + what);
  return node->items;
}

bool flag_of(const Node& node, const std::string& what) {
  const std::string& text = text_of(node, what);
  for (const char* word : {"true", "yes", "on"})
    if (text == word) return true;
  for (const char* word : {"false", "no", "off"})
    if (text == word) return false;
  throw InputError("wrong_kind", node.place,
                   "found " + in_quotes(text) + "; expected true or false for " + what + look_alike_in(text));
}

Mapping::Mapping(NodePtr node, std::string what, std::vector<std::string> known)
    : node_(std::move(node)), what_(std::move(what)) {
  if (node_->kind != Node::Kind::mapping)
    throw InputError(
        "wrong_kind", node_->place,
        "found " + describe(*node_) + "; expected " + what_ + " as a mapping" + look_alike_in(node_->text));
  for (const auto& entry : node_->entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      throw InputError("unknown_key", entry.place,
                       "unknown key " + in_quotes(entry.key) + " in " + what_ + suggestion(entry.key, known) +
                           look_alike_in(entry.key));
}

NodePtr find_entry(const Node& mapping, std::string_view key) {
  for (const auto& entry : mapping.entries)
    if (entry.key == key) return entry.value;
  return nullptr;
}

NodePtr Mapping::at(std::string_view key) const {
  if (auto node = find(key)) return node;
  throw InputError("missing_key", node_->place, what_ + " lacks the key '" + std::string(key) + "'");
}

}  // namespace mixloop
