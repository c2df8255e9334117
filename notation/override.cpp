// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>

#include "notation/document.hpp"
#include "notation/document_path.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostSteps = 32;

/// Reads `key`, `.key` and `[index]`, one after the other.
class PathReader {
 public:
  PathReader(std::string_view path, const Place& place) : path_(path), place_(place) {}

  std::vector<PathStep> steps() {
    std::vector<PathStep> steps = {key()};
    while (at_ < path_.size()) {
      if (steps.size() == kMostSteps) fail(fmt::format("more than {} steps", kMostSteps));
      ++at_;  // a dot or a bracket: key() stops at nothing else, and after an index only they may stand
      steps.push_back(path_[at_ - 1] == '[' ? index() : key());
    }
    return steps;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError("invalid_path", place_, message + " in " + in_quotes(path_));
  }

  PathStep key() {
    const std::size_t end = std::min(path_.find_first_of(".[", at_), path_.size());
    if (end == at_) fail("an empty name");
    PathStep step{std::string(path_.substr(at_, end - at_))};
    at_ = end;
    return step;
  }

  PathStep index() {
    PathStep step{"", 0, true};
    const char* const last = path_.data() + path_.size();
    const auto [end, error] = std::from_chars(path_.data() + at_, last, step.index);
    if (error != std::errc() || end == last || *end != ']') fail("expected an index such as [0]");
    at_ = static_cast<std::size_t>(end - path_.data()) + 1;
    if (at_ < path_.size() && path_[at_] != '.' && path_[at_] != '[')
      fail("expected '.' or '[' after an index");
    return step;
  }

  std::string_view path_;
  const Place& place_;
  std::size_t at_ = 0;
};

/// A copy of `node` along the path, all else shared: an alias's other uses keep their value.
NodePtr replaced(const NodePtr& node, std::span<const PathStep> steps, const NodePtr& value,
                 const Place& place) {
  if (steps.empty()) return value;
  const PathStep& step = steps.front();
  auto copy = node ? std::make_shared<Node>(*node) : std::make_shared<Node>();
  if (step.is_index) {
    if (copy->kind != Node::Kind::sequence || step.index >= copy->items.size())
      throw InputError("invalid_path", place,
                       fmt::format("no item [{}] there: it is {}", step.index, describe(*copy)));
    copy->items[step.index] = replaced(copy->items[step.index], steps.subspan(1), value, place);
    return copy;
  }
  if (copy->kind == Node::Kind::empty) copy->kind = Node::Kind::mapping, copy->place = place;
  if (copy->kind != Node::Kind::mapping)
    throw InputError("invalid_path", place,
                     "no entry " + in_quotes(step.key) + " there: it is " + describe(*copy));
  for (auto& entry : copy->entries)
    if (entry.key == step.key) {
      entry.value = replaced(entry.value, steps.subspan(1), value, place);
      return copy;
    }
  copy->entries.push_back({step.key, place, replaced(nullptr, steps.subspan(1), value, place)});
  return copy;
}

/// A number and perhaps a unit's name behind it, which is itself in YAML: a sweep sets millions of them.
bool is_plain_number(std::string_view text) {
  const auto is_one_of = [](char c, std::string_view of) { return of.find(c) != std::string_view::npos; };
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t first = !text.empty() && is_one_of(text[0], "+-.") ? 1 : 0;
  if (first == text.size() || !is_one_of(text[first], kDigits) || text.back() == ' ') return false;
  return std::ranges::all_of(text, [&](char c) {
    return is_one_of(c, kDigits) || is_one_of(c, "+-. ") || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
}

NodePtr value_of(std::string_view text, const std::string& file) {
  if (!is_plain_number(text)) return parse_document(text, file);
  auto node = std::make_shared<Node>();
  node->kind = Node::Kind::scalar;
  node->place = {file, 1, 1};
  node->text = text;
  return node;
}

}  // namespace

std::vector<PathStep> path_steps(std::string_view path, const Place& place) {
  return PathReader(path, place).steps();
}

NodePtr override_entry(const NodePtr& document, std::string_view path, std::string_view value) {
  const bool is_text = !first_non_text(path);
  const Place place{is_text ? "--set " + std::string(path) : "--set"};
  if (!is_text) throw InputError("not_text", place, "a path with a control character or invalid UTF-8");
  const auto steps = path_steps(path, place);
  return replaced(document, steps, value_of(value, place.file), place);
}

}  // namespace mixloop
