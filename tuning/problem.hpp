// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sweep/kernel/closed_loops.hpp"
#include "tuning/bound.hpp"
#include "tuning/knob.hpp"

namespace mixloop {

/// What is to be tuned, and for what: what a command line says.
struct TuneRequest {
  SweepRequest sweep;  ///< the experiment, what all runs set, and what is sampled
  std::vector<std::string> over, subject;
  std::string goal;
  bool maximises = false;
  double share = 1;  ///< of the runs that count: the worst ones beyond it don't
  int poses = 21;    ///< instants of the path at which margins are looked at
  Evaluation evaluation = Evaluation::machine_code;
};

/// What a candidate comes to.
struct Assessment {
  std::vector<double> values;  ///< of the knobs
  double goal = 0;             ///< in SI
  bool is_known = true;  ///< the goal; not where runs fail, or it was never measured: then it is infinite
  std::vector<double> bounded;   ///< what each bound is on
  std::vector<bool> held;        ///< each bound
  std::int64_t failed = 0;       ///< runs that diverged, or can't be run
  double lateness = 0;           ///< of these, 0: at their ends, to 1 each: at once, or never begun
  std::vector<double> distance;  ///< of each bound from being missed, by its size: below 0 where it is held

  bool is_feasible() const {
    for (const bool one : held)
      if (!one) return false;
    return is_known;
  }
};

/// An experiment whose numbers are tuned: what each candidate comes to in all runs, robustly.
class Problem {
 public:
  /// Reads and checks it, and assesses the experiment as it stands, to which `now` refers. Throws InputError.
  Problem(const TuneRequest& request, int threads, std::function<bool()> goes_on);

  const Setup& setup() const { return setup_; }
  const std::vector<Knob>& knobs() const { return knobs_; }
  const Criteria& criteria() const { return criteria_; }
  const Goal& goal() const { return goal_; }
  const std::vector<Bound>& bounds() const { return bounds_; }
  std::int64_t runs() const { return setup_.design().runs(); }
  /// Something is varied or drawn beside what is tuned.
  bool is_robust() const { return setup_.design().variations().size() > knobs_.size(); }
  /// Of the experiment as it stands.
  const Assessment& before() const { return before_; }

  /// What a candidate comes to over the runs. Threads share the work; their number changes no bit. Throws
  /// Interrupted where it isn't to go on.
  Assessment assess(const std::vector<double>& values) const;
  /// All criteria of a candidate by itself, nothing drawn: of `simulate` and `stability`, to the bit, but for
  /// margins that nobody asked for. What isn't measured is not a number.
  struct Alone {
    std::vector<double> criteria;
    RunEnd end = RunEnd::held;
  };
  Alone alone(const std::vector<double>& values) const;
  /// As --set takes them.
  std::vector<Override> overrides(const std::vector<double>& values) const;

 private:
  struct Run;
  std::vector<Run> gone_through(const std::vector<std::vector<Override>>& overrides) const;
  void add_margins(std::vector<Run>& runs) const;
  double worst(const std::vector<Run>& runs, std::size_t criterion, bool upwards) const;
  Assessment judged(const std::vector<double>& values, const std::vector<Run>& runs) const;
  std::vector<Run> runs_of(const std::vector<double>& values) const;
  void require_open_knobs() const;

  std::vector<Knob> knobs_;
  Setup setup_;
  Telling telling_;
  Criteria criteria_;
  Goal goal_;
  std::vector<Bound> bounds_;
  std::vector<std::size_t> margins_;  ///< criteria that are margins and asked for
  double share_;
  int poses_, threads_;
  std::function<bool()> goes_on_;
  LaneEngine engine_;
  Assessment before_;
};

}  // namespace mixloop
