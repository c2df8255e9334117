// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plant/chance.hpp"

namespace mixloop {

/// Points of Sobol's sequence, each by itself: direction numbers of S. Joe and F. Y. Kuo (2008) as Boost has
/// them, scrambled as A. B. Owen (1995) has it: bit by bit, each flipped or not by what stands before it, so
/// that points stay as even as they are and each is uniform. 52 bits.
class Sobol {
 public:
  static constexpr std::size_t kMostDimensions = 1000;

  /// Throws std::invalid_argument past kMostDimensions.
  Sobol(std::size_t dimensions, const Chance& chance);

  /// Coordinate `dimension` of point `index` (0 to 2^52 - 1), in (0, 1).
  double at(std::int64_t index, std::size_t dimension) const;

 private:
  static constexpr unsigned kBits = 52;
  using Directions = std::array<std::uint64_t, kBits>;

  Chance chance_;
  std::vector<Directions> directions_;
};

}  // namespace mixloop
