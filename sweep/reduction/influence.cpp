// SPDX-License-Identifier: MIT
#include "sweep/reduction/influence.hpp"

#include <cmath>

namespace mixloop {
namespace {

constexpr double kStudent = 2.0930;  // 97.5 % of Student's t with kGroups - 1 degrees of freedom
const double kNone = std::nan("");

}  // namespace

Influences::Influences(const std::vector<std::size_t>& classes, std::size_t metrics, bool drawn)
    : first_{0}, metrics_(metrics), drawn_(drawn) {
  for (const std::size_t count : classes) first_.push_back(first_.back() + count);
  cells_ = first_.back();
  sums_.resize((drawn_ ? kGroups : 1) * cells_ * metrics_);
  totals_.resize((drawn_ ? kGroups : 1) * metrics_);
}

void Influences::add(std::int64_t draw, std::span<const std::size_t> classes,
                     std::span<const double> metrics) {
  const std::size_t group = drawn_ ? chance_.bits(draw, 0, Draw::permutation) % kGroups : 0;
  for (std::size_t m = 0; m < metrics_; ++m) {
    const double value = metrics[m];
    if (std::isnan(value)) continue;
    Total& total = totals_[group * metrics_ + m];
    ++total.runs;
    total.sum += value;
    total.squares += value * value;
    for (std::size_t i = 0; i < classes.size(); ++i) {
      Sum& sum = sums_[(group * cells_ + first_[i] + classes[i]) * metrics_ + m];
      ++sum.runs;
      sum.sum += value;
    }
  }
}

double Influences::ratio(std::size_t entry, std::size_t metric, std::size_t without) const {
  const std::size_t groups = drawn_ ? kGroups : 1;
  Total total;
  for (std::size_t g = 0; g < groups; ++g) {
    if (g == without) continue;
    const Total& one = totals_[g * metrics_ + metric];
    total.runs += one.runs;
    total.sum += one.sum;
    total.squares += one.squares;
  }
  const double mean = total.sum / total.runs;
  const double all = total.squares - total.sum * mean;
  double between = 0;
  for (std::size_t cell = first_[entry]; cell < first_[entry + 1]; ++cell) {
    Sum of;
    for (std::size_t g = 0; g < groups; ++g) {
      if (g == without) continue;
      of.runs += sum(g, cell, metric).runs;
      of.sum += sum(g, cell, metric).sum;
    }
    if (of.runs > 0) between += of.runs * (of.sum / of.runs - mean) * (of.sum / of.runs - mean);
  }
  return all > 1e-20 * total.runs ? between / all : kNone;
}

Influence Influences::of(std::size_t entry, std::size_t metric) const {
  const double whole = ratio(entry, metric, kGroups);
  if (!drawn_ || std::isnan(whole)) return {whole, 0};
  double runs = 0;
  for (std::size_t g = 0; g < kGroups; ++g) runs += totals_[g * metrics_ + metric].runs;
  // Busing et al. (1999), h_j = N / m_j: share = g whole - sum_j (1 - 1 / h_j) share_(j).
  double share = static_cast<double>(kGroups) * whole;
  std::vector<double> pseudo(kGroups);
  std::vector<double> h(kGroups);
  for (std::size_t g = 0; g < kGroups; ++g) {
    const double left = ratio(entry, metric, g);
    h[g] = runs / totals_[g * metrics_ + metric].runs;
    if (std::isnan(left) || !std::isfinite(h[g])) return {kNone, kNone};
    share -= (1 - 1 / h[g]) * left;
    pseudo[g] = h[g] * whole - (h[g] - 1) * left;
  }
  double variance = 0;
  for (std::size_t g = 0; g < kGroups; ++g)
    variance += (pseudo[g] - share) * (pseudo[g] - share) / (h[g] - 1) / static_cast<double>(kGroups);
  return {share, kStudent * std::sqrt(variance)};
}

void Correlation::add(double x, double y) {
  if (std::isnan(x) || std::isnan(y)) return;
  ++pairs_;
  x_ += x, y_ += y;
  xx_ += x * x, xy_ += x * y, yy_ += y * y;
}

double Correlation::value() const {
  const double n = static_cast<double>(pairs_);
  const double xx = n * xx_ - x_ * x_, yy = n * yy_ - y_ * y_;
  const double least = 1e-12 * n * n;
  return xx > least && yy > least ? (n * xy_ - x_ * y_) / std::sqrt(xx * yy) : kNone;
}

}  // namespace mixloop
