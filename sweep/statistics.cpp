// SPDX-License-Identifier: MIT
#include "sweep/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr std::size_t kMostHeld = 16'000'000;

/// How far past what is expected: more than 1e300 where it diverged, the more the earlier.
double excess_of(const Expectation& expected, const Measures& measures) {
  if (measures.diverged_at) return 1e308 / (1 + *measures.diverged_at);
  double most = 0;
  for (const auto& bound : expected.bounds) {
    const double value = bound.value_in(measures);
    const double past = std::max(value - bound.most, bound.least - value) /
                        std::max(std::abs(bound.most), std::abs(bound.least));
    most = std::max(most, std::isnan(past) ? 1e299 : past);
  }
  return most;
}

/// West's running mean and sum of squares (D. H. D. West, 1979), in the runs' order.
struct Running {
  double mean = 0, squares = 0;

  void add(double value, std::int64_t count) {
    const double off = value - mean;
    mean += off / static_cast<double>(count);
    squares += off * (value - mean);
  }
};

class Gathering {
 public:
  /// `sweep`: whose bounds are judged; null: none are.
  Gathering(std::size_t columns, const Sweep* sweep)
      : sweep_(sweep), running_(columns), excess_(sweep == nullptr ? 0 : sweep->bounds().size(), -1) {
    statistics_.columns.resize(running_.size());
    statistics_.bounds.resize(excess_.size());
  }

  void take(const Outcome& outcome) {
    ++statistics_.runs;
    const auto end = static_cast<std::size_t>(outcome.end);
    if (statistics_.ends[end]++ == 0)
      statistics_.first[end] = outcome.run, statistics_.code[end] = outcome.code;
    for (std::size_t i = 0; i < running_.size(); ++i) take(i, outcome);
    if (!excess_.empty()) judge(outcome);
  }

  Statistics told() {
    for (std::size_t i = 0; i < running_.size(); ++i) {
      ColumnStatistics& column = statistics_.columns[i];
      if (column.measured > 0) column.mean = running_[i].mean;
      if (column.measured > 1)
        column.deviation = std::sqrt(running_[i].squares / static_cast<double>(column.measured - 1));
    }
    for (std::size_t i = 0; i < excess_.size(); ++i) {
      BoundStatistics& bound = statistics_.bounds[i];
      bound.is_held =
          statistics_.runs > 0 && static_cast<double>(bound.held) >=
                                      sweep_->bounds()[i].share * static_cast<double>(statistics_.runs);
    }
    return statistics_;
  }

 private:
  void take(std::size_t i, const Outcome& outcome) {
    const double value = outcome.values[i];
    if (std::isnan(value)) return;
    ColumnStatistics& column = statistics_.columns[i];
    running_[i].add(value, ++column.measured);
    if (!(value >= column.least)) column.least = value, column.run_of_least = outcome.run;
    if (!(value <= column.most)) column.most = value, column.run_of_most = outcome.run;
  }

  void judge(const Outcome& outcome) {
    const Measures measures = sweep_->telling().columns.measures(outcome);
    for (std::size_t i = 0; i < excess_.size(); ++i) {
      const Expectation& expected = sweep_->bounds()[i].expected;
      BoundStatistics& bound = statistics_.bounds[i];
      auto missed = mixloop::missed(expected, measures);
      if (!outcome.code.empty()) missed = {"it could not be run: " + outcome.code};
      if (missed.empty()) {
        ++bound.held;
        continue;
      }
      const double excess = outcome.code.empty() ? excess_of(expected, measures) : HUGE_VAL;
      if (excess <= excess_[i]) continue;
      excess_[i] = excess;
      bound.worst = outcome.run;
      bound.missed = std::move(missed);
    }
  }

  const Sweep* sweep_;
  std::vector<Running> running_;
  std::vector<double> excess_;  ///< of each bound's worst run
  Statistics statistics_;
};

/// The quantiles of some columns, by a pass over the runs.
void add_quantiles(std::size_t begin, std::size_t end, const EachRun& each,
                   std::vector<ColumnStatistics>& columns, const OnColumn& on_column) {
  std::vector<std::vector<double>> values(end - begin);
  for (std::size_t i = begin; i < end; ++i)
    values[i - begin].reserve(static_cast<std::size_t>(columns[i].measured));
  each([&](const Outcome& outcome) {
    for (std::size_t i = begin; i < end; ++i)
      if (!std::isnan(outcome.values[i])) values[i - begin].push_back(outcome.values[i]);
  });
  for (std::size_t i = begin; i < end; ++i) {
    auto& of = values[i - begin];
    for (std::size_t k = 0; k < ColumnStatistics::kShares.size() && !of.empty(); ++k) {
      const double rank = std::ceil(ColumnStatistics::kShares[k] * static_cast<double>(of.size()));
      const auto at = of.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
      std::nth_element(of.begin(), at, of.end());
      columns[i].quantiles[k] = *at;
    }
    if (on_column) on_column(i, of);
    of = {};
  }
}

Statistics gathered(Gathering gathering, const EachRun& each, const OnColumn& on_column) {
  each([&](const Outcome& outcome) { gathering.take(outcome); });
  Statistics statistics = gathering.told();
  const std::size_t runs = static_cast<std::size_t>(std::max<std::int64_t>(statistics.runs, 1));
  const std::size_t together = std::max<std::size_t>(kMostHeld / runs, 1);
  for (std::size_t begin = 0; begin < statistics.columns.size(); begin += together)
    add_quantiles(begin, std::min(begin + together, statistics.columns.size()), each, statistics.columns,
                  on_column);
  return statistics;
}

}  // namespace

Statistics statistics_of(const Sweep& sweep, const EachRun& each) {
  return gathered(Gathering(sweep.telling().columns.size(), &sweep), each, {});
}

Statistics statistics_of(std::size_t columns, const EachRun& each, const OnColumn& on_column) {
  return gathered(Gathering(columns, nullptr), each, on_column);
}

}  // namespace mixloop
