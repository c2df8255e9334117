// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sweep/table.hpp"

namespace mixloop {

/// Of one column, over the runs in which it was measured.
struct ColumnStatistics {
  static constexpr std::array kShares = {0.5, 0.9, 0.99, 0.999};

  std::int64_t measured = 0;
  double mean = kNeverMeasured, deviation = kNeverMeasured;  ///< standard, of the sample
  double least = kNeverMeasured, most = kNeverMeasured;
  std::int64_t run_of_least = -1, run_of_most = -1;
  /// The value that at least these shares of the runs don't pass: a run's own value, exact.
  std::array<double, kShares.size()> quantiles = {kNeverMeasured, kNeverMeasured, kNeverMeasured,
                                                  kNeverMeasured};
};

/// Whether a sweep's bound is held, and the run that is farthest from it.
struct BoundStatistics {
  std::int64_t held = 0;  ///< runs
  bool is_held = false;
  std::optional<std::int64_t>
      worst;  ///< of those that miss it: that diverged first, else the most past a bound
  std::vector<std::string> missed;  ///< by the worst
};

struct Statistics {
  std::int64_t runs = 0;  ///< that are there
  std::array<std::int64_t, kRunEnds> ends = {};
  std::array<std::int64_t, kRunEnds> first = {-1, -1, -1, -1, -1, -1};  ///< run that ended so
  std::array<std::string, kRunEnds> code;                               ///< its error
  std::vector<ColumnStatistics> columns;
  std::vector<BoundStatistics> bounds;
};

/// Of the runs that there are. Goes over them several times where they are many, and holds 16 million numbers
/// at most, or one column.
Statistics statistics_of(const Sweep& sweep, const EachRun& each);

/// A column's measured values, all of them in any order; may sort them.
using OnColumn = std::function<void(std::size_t column, std::vector<double>& values)>;

/// The same of outcomes with so many values, without bounds; `on_column` is told each column on the way.
Statistics statistics_of(std::size_t columns, const EachRun& each, const OnColumn& on_column);

}  // namespace mixloop
