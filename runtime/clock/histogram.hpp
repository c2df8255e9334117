// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace mixloop {

/// Durations counted in buckets that grow with the duration: fixed memory, no allocation, quantiles within
/// `kRelativeError` of the exact ones.
class Histogram {
 public:
  /// Half a bucket's width over its lower edge.
  static constexpr double kRelativeError = 1.0 / 64;

  void add(std::chrono::nanoseconds duration);

  std::uint64_t count() const { return count_; }
  /// The duration that a fraction `p` of all (0 to 1) doesn't exceed; zero where nothing was counted.
  std::chrono::nanoseconds quantile(double p) const;
  std::chrono::nanoseconds max() const { return std::chrono::nanoseconds(max_); }  ///< exact

 private:
  static constexpr int kStepBits = 5;  // 32 buckets an octave

  static std::size_t bucket(std::uint64_t value);
  static std::int64_t middle(std::size_t bucket);

  std::array<std::uint64_t, (64 - kStepBits) << kStepBits> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace mixloop
