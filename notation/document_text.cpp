// SPDX-License-Identifier: MIT
#include "notation/document_text.hpp"

#include <fmt/format.h>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr int kLevelsOfLines = 2;

/// A text as a scalar: as it is where nothing in it means anything to YAML, else in double quotes.
std::string scalar(const std::string& text) {
  static constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./ +*()^-";
  const bool is_null = text == "null" || text == "Null" || text == "NULL";
  const bool is_plain = !text.empty() && !is_null && text.find_first_not_of(kPlain) == std::string::npos &&
                        std::string_view(" -*.").find(text.front()) == std::string_view::npos &&
                        text.back() != ' ';
  const bool is_number = !text.empty() &&
                         std::string_view("-.").find(text.front()) != std::string_view::npos &&
                         text.size() > 1 && text[1] >= '0' && text[1] <= '9' &&
                         text.find_first_not_of(kPlain) == std::string::npos && text.back() != ' ';
  if (is_plain || is_number) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      quoted += fmt::format("\\{}", c);
    else if (byte < 0x20)
      quoted += fmt::format("\\x{:02x}", byte);
    else
      quoted += c;
  }
  return quoted + '"';
}

std::string on_one_line(const Node& node) {
  switch (node.kind) {
    case Node::Kind::empty:
      return "~";
    case Node::Kind::scalar:
      return scalar(node.text);
    case Node::Kind::sequence:
    case Node::Kind::mapping:
      break;
  }
  std::string text;
  for (const auto& item : node.items) text += (text.empty() ? "" : ", ") + on_one_line(*item);
  for (const auto& entry : node.entries)
    text += (text.empty() ? "" : ", ") + scalar(entry.key) + ": " + on_one_line(*entry.value);
  return node.kind == Node::Kind::sequence ? "[" + text + "]" : "{" + text + "}";
}

std::string in_lines(const Node& node, int level) {
  std::string text;
  const std::string indent(static_cast<std::size_t>(2 * level), ' ');
  for (const auto& entry : node.entries) {
    const Node& value = *entry.value;
    const std::string key = indent + scalar(entry.key) + ":";
    const bool has_mappings = !value.items.empty() && value.items.front()->kind == Node::Kind::mapping;
    if (level + 1 < kLevelsOfLines && value.kind == Node::Kind::mapping && !value.entries.empty()) {
      text += key + "\n" + in_lines(value, level + 1);
    } else if (value.kind == Node::Kind::sequence && has_mappings) {
      text += key + "\n";
      for (const auto& item : value.items) text += indent + "  - " + on_one_line(*item) + "\n";
    } else {
      text += key + " " + on_one_line(value) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string document_text(const Node& document) {
  return document.kind == Node::Kind::mapping && !document.entries.empty() ? in_lines(document, 0)
                                                                           : on_one_line(document) + "\n";
}

}  // namespace mixloop
