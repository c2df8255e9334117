// SPDX-License-Identifier: MIT
#include "notation/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace mixloop {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string joined(std::span<const std::string> words, std::string_view between) {
  std::string text;
  for (const auto& word : words) {
    if (&word != words.data()) text += between;
    text += word;
  }
  return text;
}

std::string enumerated(std::span<const std::string> words) {
  if (words.size() < 2) return joined(words);
  return joined(words.first(words.size() - 1)) + " and " + words.back();
}

std::string joined(std::span<const int> numbers, std::string_view between) {
  std::vector<std::string> words;
  for (const int number : numbers) words.push_back(std::to_string(number));
  return joined(words, between);
}

std::string joined(std::string_view format, std::span<const double> numbers, std::string_view between) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(fmt::vformat(format, fmt::make_format_args(number)));
  return joined(words, between);
}

std::string shell_word(const std::string& word) {
  const auto plain = [](char c) {
    return (std::isalnum(static_cast<unsigned char>(c)) != 0) ||
           std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace mixloop
