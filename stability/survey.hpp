// SPDX-License-Identifier: MIT
#pragma once

#include "stability/limits.hpp"

namespace mixloop {

/// The loop linearised at some instants of an experiment's path, its start first.
struct Survey {
  Sampling sampling;          ///< the experiment's
  std::vector<double> times;  ///< s, from the start of the path
  std::vector<LinearLoop> loops;
  std::string complaint;  ///< of Equations
};

/// At `poses` instants evenly spread over the path, both ends included (at least 2).
Survey survey(const Experiment& experiment, const Plan& plan, int poses);

/// The least of a limit along the path, and where.
struct Narrowest {
  std::optional<double> value;
  double time = 0;
};

struct PathLimits {
  double radius = 0;  ///< the largest
  double time_of_radius = 0;
  Narrowest tick, delay;
};
PathLimits path_limits(const Survey& survey);

/// The largest radius of all instants at another sampling.
double path_radius(const Survey& survey, const Sampling& sampling);

}  // namespace mixloop
