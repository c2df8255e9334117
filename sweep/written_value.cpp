// SPDX-License-Identifier: MIT
#include "sweep/written_value.hpp"

#include <charconv>
#include <cmath>

#include "notation/words.hpp"

namespace mixloop {

std::optional<Measure> measure_in(const std::string& text) {
  Measure measure;
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), measure.number);
  if (error != std::errc() || end == begin || !std::isfinite(measure.number)) return std::nullopt;
  measure.unit = trimmed({end, text.data() + text.size()});
  if (measure.unit.find_first_of("+-0123456789.,;'\"[]{}") == 0) return std::nullopt;
  return measure;
}

std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && (text[i] == '[' || text[i] == '{' || text[i] == '(')) ++depth;
    if (i < text.size() && (text[i] == ']' || text[i] == '}' || text[i] == ')')) --depth;
    if (i < text.size() && (text[i] != ',' || depth > 0)) continue;
    parts.emplace_back(trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  return parts;
}

}  // namespace mixloop
