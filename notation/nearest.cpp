// SPDX-License-Identifier: MIT
#include "notation/nearest.hpp"

#include <algorithm>
#include <vector>

#include "notation/utf8.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kLongestWord = 64;
constexpr std::size_t kMostListed = 24;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn a into b; letters in the
/// other case count as equal.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  const auto same = [&](std::size_t i, std::size_t j) { return lower(a[i]) == lower(b[j]); };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(i - 1, j - 1) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1))
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  if (word.size() > kLongestWord) return "";
  std::string best;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    const std::size_t distance = edits(word, candidate);
    const bool something_in_common = distance < std::max(word.size(), candidate.size());
    if (distance < fewest && something_in_common) fewest = distance, best = candidate;
  }
  return best;
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
  if (const auto near = nearest(word, candidates); !near.empty()) return "; did you mean '" + near + "'?";
  if (candidates.empty()) return "; none is known here";
  std::string text = candidates.size() == 1 ? "; expected " : "; expected one of ";
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostListed); ++i)
    text += (i ? ", " : "") + in_quotes(candidates[i]);
  if (candidates.size() > kMostListed) text += ", ... (" + std::to_string(candidates.size()) + " in all)";
  return text;
}

}  // namespace mixloop
