// SPDX-License-Identifier: MIT
#include "sweep/runs.hpp"

#include <algorithm>

namespace mixloop {

std::vector<Runs> without(std::int64_t all, std::vector<Runs> done) {
  std::ranges::sort(done, {}, &Runs::first);
  std::vector<Runs> pending;
  std::int64_t next = 0;
  for (const Runs& one : done) {
    if (one.first > next) pending.push_back({next, one.first - next});
    next = std::max(next, one.end());
  }
  if (next < all) pending.push_back({next, all - next});
  return pending;
}

// Few enough that whoever comes last has little left to do, many enough that handing out costs nothing.
std::int64_t batch_for(std::int64_t runs, std::int64_t least) {
  return std::max<std::int64_t>(least, runs < 256 ? 1 : runs < 16384 ? 8 : 64);
}

Runs Dispenser::next() {
  while (at_ < pending_.size()) {
    Runs& left = pending_[at_];
    const std::int64_t batch = left.first / share_.batch;
    const std::int64_t count = std::min(left.end(), (batch + 1) * share_.batch) - left.first;
    const Runs runs{left.first, count};
    left = {left.first + count, left.count - count};
    if (left.count == 0) ++at_;
    if (batch % share_.of == share_.index) return runs;
  }
  return {};
}

std::int64_t Dispenser::total() const {
  Dispenser other = *this;
  std::int64_t total = 0;
  for (Runs runs = other.next(); runs.count > 0; runs = other.next()) total += runs.count;
  return total;
}

}  // namespace mixloop
