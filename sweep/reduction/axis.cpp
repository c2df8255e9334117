// SPDX-License-Identifier: MIT
#include "sweep/reduction/axis.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {

std::size_t Axis::cell_of(double value) const {
  if (kind == Kind::words) return std::min(static_cast<std::size_t>(std::max(value, 0.0)), inner - 1);
  if (kind == Kind::values) {
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(values, value) - values.begin());
    return std::min(at, inner - 1);
  }
  if (value < from) return 0;
  if (value > to) return inner + 1;
  const double share = to > from ? (value - from) / (to - from) : 0;
  return 1 + std::min(static_cast<std::size_t>(share * static_cast<double>(inner)), inner - 1);
}

Axis even_axis(std::span<const double> sorted, std::size_t inner) {
  Axis axis{.inner = inner};
  if (sorted.empty()) return axis;
  const auto last = static_cast<double>(sorted.size() - 1);
  const double low = sorted[static_cast<std::size_t>(0.01 * last)];
  const double high = sorted[static_cast<std::size_t>(std::ceil(0.99 * last))];
  const double reach = high > low ? 0.5 * (high - low) : HUGE_VAL;
  axis.from = std::max(sorted.front(), low - reach);
  axis.to = std::min(sorted.back(), high + reach);
  std::size_t different = 1;
  for (auto at = std::ranges::lower_bound(sorted, axis.from);
       different < inner && (at = std::upper_bound(at, sorted.end(), *at)) != sorted.end() && *at <= axis.to;)
    ++different;
  axis.inner = std::min(inner, different);
  return axis;
}

Axis values_axis(std::vector<double> listed) {
  std::ranges::sort(listed);
  const auto again = std::ranges::unique(listed);
  listed.erase(again.begin(), again.end());
  Axis axis{.kind = Axis::Kind::values, .from = listed.front(), .to = listed.back(), .inner = listed.size()};
  axis.values = std::move(listed);
  return axis;
}

Axis words_axis(std::size_t words) {
  return {.kind = Axis::Kind::words, .from = 0, .to = static_cast<double>(words - 1), .inner = words};
}

}  // namespace mixloop
