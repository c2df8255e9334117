// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <unordered_map>

#include "notation/document.hpp"
#include "notation/look_alikes.hpp"
#include "notation/text_file.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLargestText = 1 << 20;
constexpr std::size_t kDeepest = 32;
constexpr std::size_t kMostValues = 100'000;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Finds a scalar's text in the file again: past its tag, anchor, opening quote or block header, and over
/// line breaks, which YAML folds. An escape ends the search; what comes after counts from there.
class PieceFinder {
 public:
  PieceFinder(std::string_view source, const YAML::Mark& mark)
      : source_(source),
        at_(static_cast<std::size_t>(mark.pos)),
        line_(mark.line + 1),
        column_(mark.column + 1) {}

  std::vector<Node::Piece> pieces(std::string_view text) {
    if (source_.substr(std::min(at_, source_.size())).starts_with(text)) return {};
    skip_to_text();
    std::vector<Node::Piece> found;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (is_space(text[i])) continue;
      while (is_space(peek())) step();
      if (peek() != text[i]) break;
      if (found.empty() || line_ != found.back().line ||
          column_ - found.back().column != static_cast<int>(i - found.back().offset))
        found.push_back({i, line_, column_});
      step();
    }
    return found;
  }

 private:
  char peek() const { return at_ < source_.size() ? source_[at_] : '\0'; }

  void step() {
    if (peek() == '\n') ++line_, column_ = 0;
    ++column_;
    ++at_;
  }

  void skip_to_text() {
    while (peek() == '&' || peek() == '!') {
      while (peek() != '\0' && !is_space(peek())) step();
      while (is_space(peek())) step();
    }
    if (peek() == '|' || peek() == '>')
      while (peek() != '\0' && peek() != '\n') step();
    else if (peek() == '\'' || peek() == '"')
      step();
  }

  std::string_view source_;
  std::size_t at_;
  int line_;
  int column_;
};

/// Builds the tree from yaml-cpp's events: they carry places, keys given twice and aliases, which its
/// own tree hides.
class TreeBuilder final : public YAML::EventHandler {
 public:
  /// `source` without a byte order mark, as yaml-cpp counts.
  TreeBuilder(std::string_view source, std::string file) : source_(source), file_(std::move(file)) {}

  NodePtr root() const { return root_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(made(Node::Kind::empty, mark), anchor, 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end())
      throw InputError("invalid_yaml", place(mark), "an alias to a value that contains it");
    attach(known->second.node, known->second.size, place(mark));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    auto node = made(value.empty() && tag != "!" ? Node::Kind::empty : Node::Kind::scalar, mark);
    if (first_non_text(value))
      throw InputError("not_text", node->place, "an escape that makes a control character; expected text");
    node->text = value;
    node->pieces = PieceFinder(source_, mark).pieces(value);
    finish(std::move(node), anchor, 1);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(made(Node::Kind::sequence, mark), anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(made(Node::Kind::mapping, mark), anchor);
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
    std::unordered_map<std::string, int> lines;  ///< of the keys so far
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
    Open opened;
    opened.node = std::move(node);
    opened.anchor = anchor;
    open_.push_back(std::move(opened));
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
      throw InputError("too_large", at,
                       fmt::format("more than {} values once aliases are followed", kMostValues));
    if (parent.node->kind == Node::Kind::sequence) {
      parent.node->items.push_back(std::move(node));
    } else if (!parent.has_key) {
      take_key(parent, *node, at);
    } else {
      refuse_decimal_comma(parent, *node);
      parent.node->entries.push_back({std::move(parent.key), parent.key_place, std::move(node)});
      parent.has_key = false;
    }
  }

  /// `{mass: 0,5 kg}` has the keys "mass" and "5 kg".
  static void refuse_decimal_comma(const Open& parent, const Node& value) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto& entries = parent.node->entries;
    if (value.kind != Node::Kind::empty || entries.empty() || !is_digit(parent.key[0])) return;
    const std::string& before = entries.back().value->text;
    if (before.empty() || !std::all_of(before.begin() + (before[0] == '-'), before.end(), is_digit)) return;
    throw InputError("invalid_yaml", parent.key_place,
                     fmt::format("{} where a key is expected: a comma parts entries; for {},{} write {}.{}",
                                 in_quotes(parent.key), before, parent.key, before, parent.key));
  }

  static void take_key(Open& parent, const Node& key, const Place& at) {
    if (key.kind != Node::Kind::scalar)
      throw InputError("wrong_kind", at, "a key is " + describe(key) + "; expected a name");
    if (const auto [known, is_new] = parent.lines.emplace(key.text, at.line); !is_new)
      throw InputError(
          "doubly_defined", at,
          fmt::format("{} is given twice, first at line {}", in_quotes(key.text), known->second));
    parent.has_key = true;
    parent.key = key.text;
    parent.key_place = at;
  }

  std::string_view source_;
  std::string file_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  NodePtr root_;
};

/// The line of that number, from 0.
std::string_view line_of(std::string_view text, int number) {
  for (; number > 0 && !text.empty(); --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

}  // namespace

NodePtr parse_document(std::string_view text, const std::string& file) {
  require_text(text, kLargestText, "a scene or an experiment, YAML", file);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(text, file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    NodePtr root = builder.root();
    if (!root || root->kind == Node::Kind::empty)
      throw InputError("empty_file", {file}, "found nothing; expected YAML");
    if (parser.HandleNextDocument(builder))
      throw InputError("invalid_yaml", builder.root()->place, "found a second document; expected one");
    return root;
  } catch (const YAML::Exception& error) {
    // yaml-cpp quotes the character at fault, at the end of a file a NUL: what follows it is left out.
    const std::string reason = error.msg.substr(0, first_non_text(error.msg).value_or(error.msg.size()));
    const std::string_view line = line_of(text, error.mark.line),
                           before = line_of(text, std::max(error.mark.line - 1, 0));
    std::string look_alike = look_alike_in(line);
    if (look_alike.empty()) look_alike = look_alike_in(before);  // what went wrong there shows here
    throw InputError("invalid_yaml", {file, error.mark.line + 1, error.mark.column + 1},
                     "no valid YAML: " + reason + tab_before(line) + look_alike);
  }
}

NodePtr read_document(const std::filesystem::path& path) {
  return parse_document(read_file(path, kLargestText + 1), path.string());
}

}  // namespace mixloop
