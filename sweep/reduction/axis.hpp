// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mixloop {

/// A variable's range in cells.
struct Axis {
  enum class Kind : std::uint8_t {
    even,    ///< `inner` cells of one width from `from` to `to`; before them one of all below, behind them
             ///< one of all above
    values,  ///< a cell a value
    words    ///< a cell a word, by its number; the last one has all further words
  };
  Kind kind = Kind::even;
  bool logarithmic = false;  ///< of even cells: one width of the logarithm
  double from = 0, to = 1;
  std::size_t inner = 1;
  std::vector<double> values{};  ///< ascending

  std::size_t cells() const { return kind == Kind::even ? inner + 2 : inner; }
  /// The cell of a number.
  std::size_t cell_of(double value) const;
};

/// Of numbers in ascending order: from the least to the greatest, but no farther than half as far again as
/// the middle 98 % reach; numbers of a grain, such as ticks, fall evenly into cells of some grains each,
/// `inner` at most. Of positive numbers that reach much farther above their median than below it, by their
/// logarithm.
Axis even_axis(std::span<const double> sorted, std::size_t inner);
/// Of listed numbers, in any order and some perhaps twice.
Axis values_axis(std::vector<double> listed);
Axis words_axis(std::size_t words);

}  // namespace mixloop
