// SPDX-License-Identifier: MIT
#pragma once

#include "stability/limits.hpp"

namespace mixloop {

/// The loop linearised at some instants of an experiment's path, its start first; without a path, about the
/// state that it feeds back about.
struct Survey {
  Sampling sampling;          ///< the experiment's
  std::vector<double> times;  ///< s, from the start of the path
  std::vector<LinearLoop> loops;
  std::string complaint;  ///< of Equations
};

/// Whether there is something to be stable: the state is fed back, or a path to be near to.
bool closes_loop(const Experiment& experiment);

/// At `poses` instants evenly spread over the path, both ends included (at least 2); without a path, at t = 0
/// alone, as nothing changes. Throws InputError("no_path") where there is no loop: a torque without a path.
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
