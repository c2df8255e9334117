// SPDX-License-Identifier: MIT
#include "sweep/reduction/axis.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr double kMuchFarther = 10;
constexpr std::size_t kMostDifferent = 512;
constexpr double kMostSlots = 2048;

/// The different numbers within an axis; none where they are too many.
std::vector<double> different_in(const Axis& axis, std::span<const double> sorted) {
  std::vector<double> different;
  auto at = std::ranges::lower_bound(sorted, axis.from);
  for (; at != sorted.end() && *at <= axis.to; at = std::upper_bound(at, sorted.end(), *at)) {
    if (different.size() == kMostDifferent) return {};
    different.push_back(*at);
  }
  return different;
}

/// Numbers that are whole multiples of something, ticks for instance, fall into cells of equally many of
/// these.
void fit_to_grain(Axis& axis, std::span<const double> sorted) {
  const auto different = different_in(axis, sorted);
  if (different.size() < 2) return;
  double grain = HUGE_VAL;
  for (std::size_t i = 1; i < different.size(); ++i) grain = std::min(grain, different[i] - different[i - 1]);
  const double steps = std::round((different.back() - different.front()) / grain);
  if (steps >= kMostSlots) {
    axis.inner = std::min(axis.inner, different.size());
    return;
  }
  const auto slots = static_cast<std::size_t>(steps) + 1;
  const std::size_t together = (slots + axis.inner - 1) / axis.inner;
  axis.inner = (slots + together - 1) / together;
  axis.from = different.front() - grain / 2;
  axis.to = axis.from + static_cast<double>(axis.inner * together) * grain;
}

}  // namespace

std::size_t Axis::cell_of(double value) const {
  if (kind == Kind::words) return std::min(static_cast<std::size_t>(std::max(value, 0.0)), inner - 1);
  if (kind == Kind::values) {
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(values, value) - values.begin());
    return std::min(at, inner - 1);
  }
  if (value < from) return 0;
  if (value > to) return inner + 1;
  if (to == from) return 1;
  const double share =
      logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  return 1 + std::min(static_cast<std::size_t>(share * static_cast<double>(inner)), inner - 1);
}

Axis even_axis(std::span<const double> sorted, std::size_t inner) {
  Axis axis{.inner = inner};
  if (sorted.empty()) return axis;
  const auto last = static_cast<double>(sorted.size() - 1);
  const double low = sorted[static_cast<std::size_t>(0.01 * last)];
  const double high = sorted[static_cast<std::size_t>(std::ceil(0.99 * last))];
  const double median = sorted[sorted.size() / 2];
  axis.logarithmic = sorted.front() > 0 && high - median > kMuchFarther * (median - low);
  axis.from = sorted.front();
  axis.to = sorted.back();
  if (axis.logarithmic && high > low) {
    axis.from = std::max(axis.from, low / std::sqrt(high / low));
    axis.to = std::min(axis.to, high * std::sqrt(high / low));
  } else if (high > low) {
    axis.from = std::max(axis.from, low - 0.5 * (high - low));
    axis.to = std::min(axis.to, high + 0.5 * (high - low));
  }
  if (!axis.logarithmic) fit_to_grain(axis, sorted);
  return axis;
}

Axis values_axis(std::vector<double> listed) {
  std::ranges::sort(listed);
  listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
  Axis axis{.kind = Axis::Kind::values, .from = listed.front(), .to = listed.back(), .inner = listed.size()};
  axis.values = std::move(listed);
  return axis;
}

Axis words_axis(std::size_t words) {
  return {.kind = Axis::Kind::words, .from = 0, .to = static_cast<double>(words - 1), .inner = words};
}

}  // namespace mixloop
