// SPDX-License-Identifier: MIT
#include "notation/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <sstream>

#include "notation/nearest.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLargestText = 1 << 20;
constexpr std::size_t kDeepest = 32;
constexpr std::size_t kMostValues = 100'000;

/// Builds the tree from yaml-cpp's events: they carry places, keys given twice and aliases, which its
/// own tree hides.
class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(made(Node::Kind::kEmpty, mark), anchor, 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end())
      throw InputError("invalid_yaml", place(mark), "an alias to a value that contains it");
    attach(known->second.node, known->second.size, place(mark));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    auto node = made(value.empty() && tag != "!" ? Node::Kind::kEmpty : Node::Kind::kScalar, mark);
    node->text = value;
    finish(std::move(node), anchor, 1);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(made(Node::Kind::kSequence, mark), anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(made(Node::Kind::kMapping, mark), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<Node> node;
    YAML::anchor_t anchor = 0;
    std::size_t size = 1;
    bool has_key = false;
    std::string key;
    Place key_place;
  };
  struct Anchored {
    NodePtr node;
    std::size_t size;
  };

  Place place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }

  std::shared_ptr<Node> made(Node::Kind kind, const YAML::Mark& mark) const {
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->place = place(mark);
    return node;
  }

  void open(std::shared_ptr<Node> node, YAML::anchor_t anchor) {
    if (open_.size() >= kDeepest)
      throw InputError("too_deep", node->place, fmt::format("nested deeper than {} levels", kDeepest));
    open_.push_back({std::move(node), anchor, 1, false, {}, {}});
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor, done.size);
  }

  void finish(std::shared_ptr<Node> node, YAML::anchor_t anchor, std::size_t size) {
    if (anchor != 0) anchors_[anchor] = {node, size};
    const Place at = node->place;
    attach(std::move(node), size, at);
  }

  void attach(NodePtr node, std::size_t size, const Place& at) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    parent.size += size;
    if (parent.size > kMostValues)
      throw InputError("too_large", at, fmt::format("more than {} values once aliases are followed", kMostValues));
    if (parent.node->kind == Node::Kind::kSequence) {
      parent.node->items.push_back(std::move(node));
    } else if (!parent.has_key) {
      take_key(parent, *node, at);
    } else {
      parent.node->entries.push_back({std::move(parent.key), parent.key_place, std::move(node)});
      parent.has_key = false;
    }
  }

  static void take_key(Open& parent, const Node& key, const Place& at) {
    if (key.kind != Node::Kind::kScalar)
      throw InputError("wrong_kind", at, "a key is " + describe(key) + "; expected a name");
    for (const auto& entry : parent.node->entries)
      if (entry.key == key.text)
        throw InputError("doubly_defined", at,
                         fmt::format("'{}' is given twice, first at line {}", key.text, entry.place.line));
    parent.has_key = true;
    parent.key = key.text;
    parent.key_place = at;
  }

  std::string file_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  NodePtr root_;
};

/// A text file holds no control characters but tab, line feed and carriage return.
void refuse_binary(std::string_view text, const std::string& file) {
  int line = 1, column = 1;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f || byte == 0xff || byte == 0xfe)
      throw InputError("not_text", {file, line, column},
                       fmt::format("byte 0x{:02x}: this is no text file; expected YAML in UTF-8", byte));
    if (c == '\n') ++line, column = 0;
    ++column;
  }
}

void refuse_large(std::size_t size, const std::string& file) {
  if (size > kLargestText)
    throw InputError("too_large", {file}, fmt::format("larger than {} bytes; expected a scene or an experiment", kLargestText));
}

}  // namespace

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kEmpty: return "nothing";
    case Node::Kind::kScalar: return "'" + (node.text.size() > 60 ? node.text.substr(0, 57) + "..." : node.text) + "'";
    case Node::Kind::kSequence: return fmt::format("a list of {}", node.items.size());
    case Node::Kind::kMapping: return "a mapping";
  }
  return "";
}

const std::string& text_of(const Node& node, const std::string& what) {
  if (node.kind != Node::Kind::kScalar)
    throw InputError("wrong_kind", node.place, "found " + describe(node) + "; expected " + what);
  return node.text;
}

std::vector<NodePtr> items_of(const NodePtr& node, const std::string& what) {
  if (node->kind == Node::Kind::kScalar) return {node};
  if (node->kind != Node::Kind::kSequence)
    throw InputError("wrong_kind", node->place, "found " + describe(*node) + "; expected " + what);
  return node->items;
}

bool flag_of(const Node& node, const std::string& what) {
  const std::string& text = text_of(node, what);
  for (const char* word : {"true", "yes", "on"})
    if (text == word) return true;
  for (const char* word : {"false", "no", "off"})
    if (text == word) return false;
  throw InputError("wrong_kind", node.place, "found '" + text + "'; expected true or false for " + what);
}

Mapping::Mapping(NodePtr node, std::string what, std::vector<std::string> known)
    : node_(std::move(node)), what_(std::move(what)) {
  if (node_->kind != Node::Kind::kMapping)
    throw InputError("wrong_kind", node_->place, "found " + describe(*node_) + "; expected " + what_ + " as a mapping");
  for (const auto& entry : node_->entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      throw InputError("unknown_key", entry.place,
                       "unknown key '" + entry.key + "' in " + what_ + suggestion(entry.key, known));
}

NodePtr Mapping::find(std::string_view key) const {
  for (const auto& entry : node_->entries)
    if (entry.key == key) return entry.value;
  return nullptr;
}

NodePtr Mapping::at(std::string_view key) const {
  if (auto node = find(key)) return node;
  throw InputError("missing_key", node_->place, what_ + " lacks the key '" + std::string(key) + "'");
}

NodePtr parse_document(std::string_view text, const std::string& file) {
  refuse_large(text.size(), file);
  refuse_binary(text, file);
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    const NodePtr root = builder.root();
    if (!root || root->kind == Node::Kind::kEmpty) throw InputError("empty_file", {file}, "nothing in this file");
    if (parser.HandleNextDocument(builder))
      throw InputError("invalid_yaml", builder.root()->place, "a second document; expected one");
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError("invalid_yaml", {file, error.mark.line + 1, error.mark.column + 1}, "no valid YAML: " + error.msg);
  }
}

NodePtr read_document(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw InputError("no_such_file", {path.string()}, "no such file");
  if (std::filesystem::is_directory(path, failure))
    throw InputError("no_such_file", {path.string()}, "a directory; expected a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError("no_such_file", {path.string()}, "cannot be read");
  std::string text(kLargestText + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return parse_document(text, path.string());
}

namespace {

/// One step of a path: a key, or an index into a list.
struct Step {
  std::string key;
  std::size_t index = 0;
  bool is_index = false;
};

std::vector<Step> steps_of(std::string_view path, const Place& place) {
  std::vector<Step> steps;
  std::string key;
  const auto flush = [&](bool required) {
    if (key.empty() && required) throw InputError("invalid_path", place, "an empty name in '" + std::string(path) + "'");
    if (!key.empty()) steps.push_back({std::move(key)});
    key.clear();
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '.') {
      flush(i == 0 || path[i - 1] != ']');
    } else if (path[i] == '[') {
      flush(i == 0 || path[i - 1] != ']');
      Step step{"", 0, true};
      const auto [end, error] = std::from_chars(path.data() + i + 1, path.data() + path.size(), step.index);
      if (error != std::errc() || end == path.data() + path.size() || *end != ']')
        throw InputError("invalid_path", place, "expected an index such as [0] in '" + std::string(path) + "'");
      i = static_cast<std::size_t>(end - path.data());
      steps.push_back(step);
    } else {
      key += path[i];
    }
  }
  flush(path.empty() || path.back() != ']');
  return steps;
}

NodePtr replaced(const NodePtr& node, std::span<const Step> steps, const NodePtr& value, const Place& place) {
  if (steps.empty()) return value;
  const Step& step = steps.front();
  auto copy = node ? std::make_shared<Node>(*node) : std::make_shared<Node>();
  if (!node || node->kind == Node::Kind::kEmpty) copy->kind = Node::Kind::kMapping, copy->place = place;
  if (step.is_index) {
    if (copy->kind != Node::Kind::kSequence || step.index >= copy->items.size())
      throw InputError("invalid_path", place, fmt::format("no item [{}] there: it is {}", step.index, describe(*copy)));
    copy->items[step.index] = replaced(copy->items[step.index], steps.subspan(1), value, place);
    return copy;
  }
  if (copy->kind != Node::Kind::kMapping)
    throw InputError("invalid_path", place, "no entry '" + step.key + "' there: it is " + describe(*copy));
  for (auto& entry : copy->entries)
    if (entry.key == step.key) {
      entry.value = replaced(entry.value, steps.subspan(1), value, place);
      return copy;
    }
  copy->entries.push_back({step.key, place, replaced(nullptr, steps.subspan(1), value, place)});
  return copy;
}

}  // namespace

NodePtr override_entry(const NodePtr& document, std::string_view path, std::string_view value) {
  const Place place{"--set " + std::string(path)};
  const auto steps = steps_of(path, place);
  const NodePtr parsed = parse_document(value, place.file);
  return replaced(document, steps, parsed, place);
}

}  // namespace mixloop
