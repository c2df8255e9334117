// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tuning/criteria.hpp"

namespace mixloop {

/// What is to come least, or most, of what is asked of a candidate: of several criteria the worst.
struct Goal {
  std::string name;
  std::vector<std::size_t> criteria;  ///< of one unit
  bool maximises = false;
};

/// Throws InputError("unknown_value") at `--minimise` or `--maximise`.
Goal read_goal(const std::string& name, bool maximises, const Criteria& criteria);

/// What a candidate must keep.
struct Bound {
  std::string text;  ///< as it was written
  Place place;
  std::size_t criterion = 0;
  bool is_upper = true;   ///< `<` or `<=`, else `>` or `>=`
  bool is_strict = true;  ///< `<` or `>`
  double limit = 0;       ///< in SI
  /// Of `now` and `0.9 now`: the limit is so many times what the experiment comes to before it is tuned.
  std::optional<double> times_now;

  bool holds(double value) const {
    if (is_upper) return is_strict ? value < limit : value <= limit;
    return is_strict ? value > limit : value >= limit;
  }
};

/// Of `max_torque < 5 N m`, `max_torque <= [2, 5, 3] N m`, `longest_delay >= now`: one for each criterion
/// that the name means. Throws InputError at `--subject TEXT`.
std::vector<Bound> read_bounds(const std::string& text, const Criteria& criteria);

}  // namespace mixloop
