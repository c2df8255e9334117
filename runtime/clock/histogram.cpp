// SPDX-License-Identifier: MIT
#include "runtime/clock/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mixloop {

// Values below 2^kStepBits have a bucket each. Above, an octave [2^e, 2^(e+1)) has 2^kStepBits of them,
// each 2^(e - kStepBits) wide.
std::size_t Histogram::bucket(std::uint64_t value) {
  const int exponent = std::max(static_cast<int>(std::bit_width(value)) - 1, kStepBits);
  const int shift = exponent - kStepBits;
  return (static_cast<std::size_t>(shift) << kStepBits) + static_cast<std::size_t>(value >> shift);
}

std::int64_t Histogram::middle(std::size_t bucket) {
  constexpr std::size_t kSteps = std::size_t{1} << kStepBits;
  if (bucket < 2 * kSteps) return static_cast<std::int64_t>(bucket);
  const auto shift = static_cast<int>(bucket / kSteps) - 1;
  const std::uint64_t lower = static_cast<std::uint64_t>(kSteps + bucket % kSteps) << shift;
  return static_cast<std::int64_t>(lower + (std::uint64_t{1} << shift) / 2);
}

void Histogram::add(std::chrono::nanoseconds duration) {
  const std::int64_t value = std::max<std::int64_t>(duration.count(), 0);
  ++counts_[bucket(static_cast<std::uint64_t>(value))];
  ++count_;
  max_ = std::max(max_, value);
}

std::chrono::nanoseconds Histogram::quantile(double p) const {
  if (count_ == 0) return std::chrono::nanoseconds(0);
  const auto rank =
      static_cast<std::uint64_t>(std::ceil(std::clamp(p, 0.0, 1.0) * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    seen += counts_[i];
    if (seen > 0 && seen >= rank) return std::chrono::nanoseconds(std::min(middle(i), max_));
  }
  return max();
}

}  // namespace mixloop
