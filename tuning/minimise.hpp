// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace mixloop {

/// A function of unknowns between 0 and 1 that is to come least where none of its constraints is above 0.
struct Minimisation {
  struct Value {
    double objective = 0;
    std::vector<double> constraints;
  };

  std::size_t constraints = 0;  ///< how many
  /// All of them finite. May throw, which ends the search, and reaches whoever began it.
  std::function<Value(std::span<const double> at)> at;
};

/// Whether this build has what searches (NLopt).
bool can_minimise();

/// Looks all over the unit cube, by about so many evaluations, from its middle on: DIRECT-L with hidden
/// constraints (J. M. Gablonsky & C. T. Kelley, 2001), the same points every time.
void look_around(const Minimisation& problem, std::size_t unknowns, int evaluations);

/// Goes down from a point by linear models on a simplex, at first so wide, until it is narrower than `end`:
/// COBYLA (M. J. D. Powell, 1994), the same points every time.
void go_down(const Minimisation& problem, const std::vector<double>& start, double step, double end);

}  // namespace mixloop
