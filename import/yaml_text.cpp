// SPDX-License-Identifier: MIT
#include "import/yaml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notation/value.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kWidest = 116;

/// Whether the text stands for itself without quotes.
bool is_plain(std::string_view text) {
  const auto is_alpha = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_inside = [&](char c) {
    return is_alpha(c) || (c >= '0' && c <= '9') ||
           std::string_view("_-./").find(c) != std::string_view::npos;
  };
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return !text.empty() && is_alpha(text.front()) && std::all_of(text.begin(), text.end(), is_inside) &&
         lower != "null";
}

/// What a scene makes of it, rad.
double of_degrees(double degrees) {
  Node node{.kind = Node::Kind::scalar};
  node.text = fmt::format("{} deg", degrees);
  return number_of(node, kPure, "an angle");
}

/// The last comma between entries of a line that is too long, within its width; 0 where there is none.
std::size_t last_comma(const std::string& line) {
  std::size_t last = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; line.size() > kWidest && i < kWidest; ++i) {
    if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) is_quoted = !is_quoted;
    if (!is_quoted && line.compare(i, 2, ", ") == 0) last = i;
  }
  return last;
}

template <class Text>
std::string listed(std::span<const double> values, const Text& text) {
  std::string all;
  for (const double value : values) all += (all.empty() ? "" : ", ") + text(value);
  return "[" + all + "]";
}

}  // namespace

std::string yaml_text(std::string_view text) {
  if (is_plain(text)) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string quantity(double value, std::string_view unit) {
  return value == 0 ? "0" : fmt::format("{} {}", value, unit);
}

std::string angle_text(double radians) {
  const double degrees = std::round(radians * 360 / std::numbers::pi) / 2;
  if (degrees != 0 && std::abs(degrees) <= 3600 && of_degrees(degrees) == radians)
    return quantity(degrees, "deg");
  return quantity(radians, "rad");
}

std::string list_text(std::span<const double> values, std::string_view unit) {
  return listed(values, [&](double value) { return quantity(value, unit); });
}

std::string angles_text(std::span<const double> radians) { return listed(radians, angle_text); }

std::string broken_lines(std::string_view yaml) {
  std::string text;
  while (!yaml.empty()) {
    std::string line(yaml.substr(0, yaml.find('\n')));
    yaml.remove_prefix(std::min(line.size() + 1, yaml.size()));
    const std::string indent(line.find_first_not_of(" -") + 3, ' ');
    for (std::size_t comma = last_comma(line); comma > 0; comma = last_comma(line)) {
      text += line.substr(0, comma + 1) + "\n";
      line = indent + line.substr(comma + 2);
    }
    text += line + "\n";
  }
  return text;
}

std::string comment(std::string_view text) {
  std::string lines, line = "#";
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (line.size() > 1 && line.size() + 1 + word.size() > kWidest) {
      lines += line + "\n";
      line = "#  ";
    }
    line += " ";
    line += word;
  }
  return lines + line + "\n";
}

}  // namespace mixloop
