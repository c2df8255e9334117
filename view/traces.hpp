// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace mixloop {

/// What the live plots draw of a tick.
struct Trace {
  double t = 0;                                        ///< plant time, s
  float error = 0;                                     ///< m; NaN where the desired place isn't known
  std::vector<float> tau;                              ///< n_u, commanded; NaN where no command came
  std::array<float, 3> place = {std::nanf(""), 0, 0};  ///< of the end effector, m; NaN where it isn't known
};

/// The latest ticks, for plots of any speed: who asks late gets the least and the greatest of what was
/// missed.
class Traces {
 public:
  Traces(std::size_t n_u, std::size_t most) : n_u_(n_u), most_(most) {}

  void add(Trace trace);
  void clear() { ticks_.clear(); }
  /// How many were ever added: where a reader has come to.
  std::int64_t count() const { return count_; }
  const std::deque<Trace>& all() const { return ticks_; }

  /// Those added since `from`, as JSON {"t": [...], "error": [...], "tau": [[...], ...], "way": [t, x, y, z,
  /// ...]}: each tick, or where they are more than `most_points`, the least and the greatest of each of as
  /// many stretches as half of that; of the way, as many places evenly picked, the last one among them.
  std::string since(std::int64_t from, std::size_t most_points) const;

 private:
  void write_way(fmt::memory_buffer& out, std::size_t first, std::size_t most) const;

  std::size_t n_u_, most_;
  std::deque<Trace> ticks_;
  std::int64_t count_ = 0;
};

}  // namespace mixloop
