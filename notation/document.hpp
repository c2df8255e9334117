// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "notation/errors.hpp"

namespace mixloop {

struct Node;
using NodePtr = std::shared_ptr<const Node>;

/// One value of a YAML document, with its place. Scalars stay text until somebody knows what they mean.
struct Node {
  enum class Kind { empty, scalar, sequence, mapping };
  struct Entry {
    std::string key;
    Place place;
    NodePtr value;
  };
  /// A stretch of a scalar's text, from `offset` on, that stands unbroken in the file.
  struct Piece {
    std::size_t offset = 0;
    int line = 0;
    int column = 0;
  };

  Kind kind = Kind::empty;
  Place place;
  std::string text;            ///< scalar
  std::vector<Piece> pieces;   ///< scalar: where quotes or line breaks part the text from `place`
  std::vector<NodePtr> items;  ///< sequence
  std::vector<Entry> entries;  ///< mapping, in the order of the file, keys unique
};

/// What the node is, for messages: "'abc'", "a list of 3", "a mapping", "nothing".
std::string describe(const Node& node);

/// Where the character at `offset` of a scalar's text stands in the file.
Place place_in(const Node& scalar, std::size_t offset);

/// The scalar's text; throws InputError("wrong_kind") saying that `what` was expected.
const std::string& text_of(const Node& node, const std::string& what);
/// The list's items, or a lone value as a list of one; throws where the node is empty or a mapping.
std::vector<NodePtr> items_of(const NodePtr& node, const std::string& what);
/// true or false (yes/no, on/off); throws otherwise.
bool flag_of(const Node& node, const std::string& what);

/// The value of a mapping's entry, or null when there is none.
NodePtr find_entry(const Node& mapping, std::string_view key);

/// A mapping whose keys are known beforehand. Construction throws InputError: "wrong_kind" when the
/// node is no mapping, "unknown_key" (with the nearest known one) for any other key.
class Mapping {
 public:
  Mapping(NodePtr node, std::string what, std::vector<std::string> known);

  /// The value, or null when the key is absent.
  NodePtr find(std::string_view key) const { return find_entry(*node_, key); }
  /// The value; throws InputError("missing_key") naming the mapping's place when absent.
  NodePtr at(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  const Node& node() const { return *node_; }
  const std::string& what() const { return what_; }

 private:
  NodePtr node_;
  std::string what_;
};

/// Reads one YAML document. Throws InputError, with line and column (in bytes), for what is no YAML, for a
/// file that is empty or no text, a key given twice, a control character, nesting past 32 levels, more than
/// 100,000 values once aliases are followed, or more than 1 MiB.
NodePtr parse_document(std::string_view text, const std::string& file);
NodePtr read_document(const std::filesystem::path& path);

/// The document with the entry at `path` (`plant.command_delay`, `controller.kp[0]`) replaced by `value`,
/// itself YAML; entries that are absent are made. Throws InputError where the path leads through a value
/// that is no mapping or list, past a list's end, or deeper than 32 steps.
NodePtr override_entry(const NodePtr& document, std::string_view path, std::string_view value);

}  // namespace mixloop
