// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace mixloop {

/// Runs in the cells of two axes: how many, and of each of some metrics its mean and its worst.
class Density {
 public:
  struct Metric {
    std::int64_t measured = 0;
    double sum = 0;
    double worst = 0;
    std::int64_t run = -1;  ///< of the worst; of equal ones the first that came

    double mean() const { return sum / static_cast<double>(measured); }
  };

  /// `least_is_worst`: of each metric, whether the least is; else the greatest.
  Density(std::size_t cells_x, std::size_t cells_y, std::vector<bool> least_is_worst);

  /// A run that lies in cell (x, y); a metric that was not measured is not a number.
  void add(std::size_t x, std::size_t y, std::int64_t run, std::span<const double> metrics);

  std::size_t cells() const { return runs_.size(); }  ///< x * cells_y + y
  std::int64_t runs(std::size_t cell) const { return runs_[cell]; }
  const Metric& metric(std::size_t cell, std::size_t metric) const {
    return metrics_[cell * least_is_worst_.size() + metric];
  }

 private:
  std::size_t cells_y_;
  std::vector<bool> least_is_worst_;
  std::vector<std::int64_t> runs_;
  std::vector<Metric> metrics_;
};

}  // namespace mixloop
