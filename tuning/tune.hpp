// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "tuning/problem.hpp"

namespace mixloop {

/// How far a search is.
struct TuneProgress {
  std::int64_t done = 0, of = 0;     ///< evaluations
  double rate = 0;                   ///< a second
  const Assessment* best = nullptr;  ///< so far
};

/// The best of all candidates that were looked at.
struct Tuned {
  Assessment best;               ///< feasible where one was; else the one that misses the least
  std::int64_t evaluations = 0;  ///< candidates, the experiment as it stands among them
  bool improves = false;         ///< on what stands
  bool interrupted = false;
};

/// Whether one candidate is to be preferred: first that runs don't fail, then what bounds are missed by, then
/// the goal.
bool is_better(const Assessment& a, const Assessment& b, const Goal& goal);

/// Searches by at most so many evaluations: a quarter of them, or 20 a knob and 20, all over between the
/// knobs' ends, from the middle, the rest down from the best that there is, again and again on smaller
/// simplices. Ends early where the problem isn't to go on. Only what holds all bounds exactly can be the
/// best, unless nothing does.
Tuned tune(const Problem& problem, std::int64_t evaluations,
           const std::function<void(const TuneProgress&)>& told);

}  // namespace mixloop
