// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plant/chance.hpp"

namespace mixloop {

/// How much an entry moves a metric by itself.
struct Influence {
  /// First-order Sobol' index V(E[Y | X]) / V(Y): the share of the metric's variance that would go if the
  /// entry were known. Not a number where the metric doesn't vary or was too seldom measured.
  double share = 0;
  double doubt = 0;  ///< half of its 95 % interval; 0 where all values of a grid were gone through: exact
};

/// First-order Sobol' indices from the runs that there are, whatever their design: the correlation ratio
/// over classes of the entry (K. Pearson, 1905; E. Plischke, An effective algorithm for computing global
/// sensitivity indices (EASI), Reliability Engineering & System Safety 95, 2010; E. Plischke, E. Borgonovo &
/// C. L. Smith, Global sensitivity measures from given data, European Journal of Operational Research 226,
/// 2013). Of M classes and N runs it is too great by about (1 - share) (M - 1) / N, and too small by what the
/// metric varies within a class: of a straight line 1 / M^2 of it. Where runs were drawn, the first bias is
/// taken off, and the doubt found, by leaving out one group of draws after the other (the jackknife; F. M. T.
/// A. Busing, E. Meijer & R. van der Leeden, Delete-m jackknife for unequal m, Statistics and Computing 9,
/// 1999). All runs of a draw are in one group: they are no independent ones.
class Influences {
 public:
  static constexpr std::size_t kGroups = 20;

  /// `classes`: of each entry, how many. `drawn`: the runs are samples; else all of a grid.
  Influences(const std::vector<std::size_t>& classes, std::size_t metrics, bool drawn);

  /// A run: its draw, each entry's class, each metric (best with a mean near 0), not a number where it wasn't
  /// measured.
  void add(std::int64_t draw, std::span<const std::size_t> classes, std::span<const double> metrics);

  Influence of(std::size_t entry, std::size_t metric) const;

 private:
  struct Sum {
    double runs = 0, sum = 0;
  };
  struct Total : Sum {
    double squares = 0;
  };
  const Sum& sum(std::size_t group, std::size_t cell, std::size_t metric) const {
    return sums_[(group * cells_ + cell) * metrics_ + metric];
  }
  /// Over all groups but one; kGroups: over all.
  double ratio(std::size_t entry, std::size_t metric, std::size_t without) const;

  std::vector<std::size_t> first_;  ///< cell of each entry, and where the last one's end
  std::size_t metrics_, cells_;
  bool drawn_;
  Chance chance_{0x6a61636b6b6e6966};
  std::vector<Sum> sums_;
  std::vector<Total> totals_;
};

/// Pearson's correlation of two numbers that come by pairs; of ranks it is Spearman's.
class Correlation {
 public:
  void add(double x, double y);
  std::int64_t pairs() const { return pairs_; }
  /// -1 to 1; not a number where one of them doesn't vary.
  double value() const;

 private:
  std::int64_t pairs_ = 0;
  double x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
};

}  // namespace mixloop
