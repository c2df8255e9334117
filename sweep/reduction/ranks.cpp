// SPDX-License-Identifier: MIT
#include "sweep/reduction/ranks.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {

Ranks::Ranks(std::span<const double> sorted) {
  const double all = static_cast<double>(sorted.size());
  for (std::size_t k = 1; k <= kSteps && !sorted.empty(); ++k) {
    const double last = sorted[(k * sorted.size() + kSteps - 1) / kSteps - 1];
    if (last_.empty() || last > last_.back()) last_.push_back(last);
  }
  double below = 0;
  for (const double last : last_) {
    const auto upto = static_cast<double>(std::ranges::upper_bound(sorted, last) - sorted.begin());
    middle_.push_back((below + upto) / (2 * all));
    below = upto;
  }
}

double Ranks::share_below(double value) const {
  if (std::isnan(value) || last_.empty()) return std::nan("");
  const auto at = static_cast<std::size_t>(std::ranges::lower_bound(last_, value) - last_.begin());
  return middle_[std::min(at, middle_.size() - 1)];
}

}  // namespace mixloop
