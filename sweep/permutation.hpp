// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "plant/chance.hpp"

namespace mixloop {

/// A random permutation of 0 to size - 1 of which each value is had by itself: a balanced Feistel network on
/// the smallest 4^b numbers that are enough, walked along its cycle until it is back within the size.
class Permutation {
 public:
  /// Those of other channels of the same chance are others.
  Permutation(std::int64_t size, const Chance& chance, std::size_t channel)
      : size_(size), chance_(chance), channel_(channel) {
    while ((std::int64_t{1} << (2 * half_bits_)) < size) ++half_bits_;
  }

  std::int64_t at(std::int64_t index) const {
    do index = once(index);
    while (index >= size_);
    return index;
  }

 private:
  static constexpr unsigned kRounds = 8;

  std::int64_t once(std::int64_t index) const {
    const std::int64_t mask = (std::int64_t{1} << half_bits_) - 1;
    std::int64_t left = index >> half_bits_, right = index & mask;
    for (unsigned round = 0; round < kRounds; ++round) {
      const std::uint64_t bits = chance_.bits(right, channel_ * kRounds + round, Draw::permutation);
      const std::int64_t mixed = left ^ (static_cast<std::int64_t>(bits >> 1) & mask);
      left = right;
      right = mixed;
    }
    return (left << half_bits_) | right;
  }

  std::int64_t size_;
  Chance chance_;
  std::size_t channel_;
  int half_bits_ = 1;
};

}  // namespace mixloop
