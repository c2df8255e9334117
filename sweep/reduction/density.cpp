// SPDX-License-Identifier: MIT
#include "sweep/reduction/density.hpp"

#include <cmath>

namespace mixloop {

Density::Density(std::size_t cells_x, std::size_t cells_y, std::vector<bool> least_is_worst)
    : cells_y_(cells_y),
      least_is_worst_(std::move(least_is_worst)),
      runs_(cells_x * cells_y),
      metrics_(runs_.size() * least_is_worst_.size()) {}

void Density::add(std::size_t x, std::size_t y, std::int64_t run, std::span<const double> metrics) {
  const std::size_t cell = x * cells_y_ + y;
  ++runs_[cell];
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const double value = metrics[i];
    if (std::isnan(value)) continue;
    Metric& metric = metrics_[cell * metrics.size() + i];
    ++metric.measured;
    metric.sum += value;
    if (metric.run >= 0 && !(least_is_worst_[i] ? value < metric.worst : value > metric.worst)) continue;
    metric.worst = value;
    metric.run = run;
  }
}

}  // namespace mixloop
