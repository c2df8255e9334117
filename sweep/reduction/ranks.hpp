// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mixloop {

/// Where a value stands among all those of its column, in a thousand steps of equally many: of fewer
/// different values exactly, equal ones at the middle of their places.
class Ranks {
 public:
  static constexpr std::size_t kSteps = 1024;

  Ranks() = default;
  /// Of values in ascending order.
  explicit Ranks(std::span<const double> sorted);

  /// The share of the values that lie below it, those that share its step counted by half: 0 to 1. Not a
  /// number of what is none.
  double share_below(double value) const;

 private:
  std::vector<double> last_;    ///< of each step
  std::vector<double> middle_;  ///< share below it
};

}  // namespace mixloop
