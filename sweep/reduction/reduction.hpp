// SPDX-License-Identifier: MIT
#pragma once

#include "sweep/reduction/density.hpp"
#include "sweep/reduction/influence.hpp"
#include "sweep/reduction/variable.hpp"

namespace mixloop {

/// What moves a metric.
struct MetricInfluence {
  /// Why it isn't told.
  enum class Missing : std::uint8_t {
    none,
    too_few,    ///< draws in which it was measured
    partly_run  ///< a grid, of which the runs that there are cover a corner
  };
  struct OfEntry {
    std::size_t entry = 0;  ///< a Variable
    std::size_t classes = 0;
    Influence influence;
    Influence on_ranks;  ///< the same of the metric's ranks, in which a few runs far out count as all others
    double rank_correlation = 0;  ///< Spearman's; of words not a number: they have no order
  };

  std::size_t metric = 0;  ///< a Variable
  Missing missing = Missing::none;
  std::int64_t runs = 0;         ///< in which it was measured
  std::vector<OfEntry> entries;  ///< that vary
};

/// Runs in the cells of two variables.
struct DensityMap {
  std::size_t x = 0, y = 0;  ///< Variables
  Density density;
};

/// One of the worst runs.
struct WorstRun {
  std::int64_t run = 0;
  double value = 0;
  RunEnd end = RunEnd::held;
};

/// What the pictures of a sweep need, however many its runs.
struct Reduction {
  Statistics ends;  ///< runs, ends, first and code alone
  std::vector<Variable> variables;
  std::vector<std::size_t> metrics;          ///< those that vary beside the entries
  std::vector<std::size_t> placed;           ///< entries that maps have: those that move the metrics most
  std::vector<Axis> axes;                    ///< of each variable in maps
  std::vector<DensityMap> maps;              ///< of each two placed entries, and of each with each metric
  std::vector<MetricInfluence> influences;   ///< of each metric
  std::vector<std::vector<WorstRun>> worst;  ///< of each metric, the worst first
};

/// Reduces a sweep's runs: goes over them a few times, and holds 16 million numbers at most, or one column.
/// The same runs give the same.
Reduction reduced(const KeptSweep& sweep, const EachRun& each);

}  // namespace mixloop
