// SPDX-License-Identifier: MIT
#include "tuning/tune.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include "notation/long_work.hpp"
#include "tuning/minimise.hpp"

namespace mixloop {
namespace {

// Of a search; lengths in shares of the way between a knob's ends.
constexpr double kInside =
    2e-4;  // so far, of a bound's size, the search stays from it: its last points hold it
constexpr double kFirstStep = 0.1, kNextStep = 0.4, kLastStep = 1e-3;  // of simplices: the first one, from
                                                                       // one to the next, the least
constexpr std::int64_t kAround = 20;     // looks all over, for each unknown and one more, at most
constexpr std::size_t kMostAround = 60;  // unknowns that DIRECT takes
constexpr double kWideStep = 0.3;        // where a descent has come to its end, from which others go on
constexpr double kWorthwhile = 1e-3;     // what a simplex gains of the goal for the next one to be as large
constexpr double kFailed = 10;           // what a failed run counts as, goals being 1 as they stand

/// What its bounds are missed by in all.
double missed(const Assessment& one) {
  double sum = 0;
  for (std::size_t i = 0; i < one.held.size(); ++i)
    if (!one.held[i]) sum += std::clamp(one.distance[i], 0.0, kFailed);
  return sum;
}

struct Enough {};

class Searcher {
 public:
  Searcher(const Problem& problem, std::int64_t evaluations,
           const std::function<void(const TuneProgress&)>& told)
      : problem_(problem),
        most_(evaluations),
        told_(told),
        tuned_{.best = problem.before(), .evaluations = 1} {
    const double goal = std::abs(problem.before().goal);
    size_ = std::isfinite(goal) && goal > 0 ? goal : 1;
    seen_.emplace(problem.before().values, value_of(problem.before()));
  }

  Tuned run() {
    try {
      search();
    } catch (const Enough&) {
    } catch (const Interrupted&) {
      tuned_.interrupted = true;
    }
    tuned_.improves = is_better(tuned_.best, problem_.before(), problem_.goal());
    return std::move(tuned_);
  }

 private:
  void search() {
    const std::size_t unknowns = problem_.knobs().size();
    const Minimisation problem{.constraints = problem_.bounds().size(),
                               .at = [this](auto x) { return at(x); }};
    const auto around = static_cast<int>(
        std::min((most_ - tuned_.evaluations) / 4, kAround * static_cast<std::int64_t>(unknowns + 1)));
    around_ = tuned_.evaluations + around;
    if (around > static_cast<int>(2 * unknowns) && unknowns <= kMostAround) try {
        look_around(problem, unknowns, around);
      } catch (const Enough&) {
      }
    around_ = most_;
    for (double widest = kFirstStep;; widest = kWideStep) {
      const Assessment before = tuned_.best;
      for (double step = widest; step >= kLastStep;) {
        const Assessment last = tuned_.best;
        go_down(problem, shares(last.values), step, step / 100);
        if (!gained(last)) step *= kNextStep;
      }
      if (widest == kWideStep && !gained(before)) return;
    }
  }

  bool gained(const Assessment& before) const {
    const Assessment& now = tuned_.best;
    if (!is_better(now, before, problem_.goal())) return false;
    if (missed(now) < missed(before) || now.failed < before.failed) return true;
    return std::abs(now.goal - before.goal) > kWorthwhile * size_;
  }

  std::vector<double> shares(const std::vector<double>& values) const {
    std::vector<double> shares;
    for (std::size_t i = 0; i < values.size(); ++i)
      shares.push_back(std::clamp(problem_.knobs()[i].share(values[i]), 0.0, 1.0));
    return shares;
  }

  /// Finite, and in order: a run that fails is worse than any that doesn't, and the earlier it does the
  /// worse.
  Minimisation::Value value_of(const Assessment& one) const {
    const double failed = kFailed * (1 + one.lateness / static_cast<double>(problem_.runs()));
    const double goal = (problem_.goal().maximises ? -1 : 1) * one.goal / size_;
    Minimisation::Value value{.objective = one.is_known ? std::clamp(goal, -kFailed, kFailed) : failed,
                              .constraints = {}};
    for (const double distance : one.distance)
      value.constraints.push_back(std::isnan(distance) ? failed
                                  : std::isfinite(distance) || distance < 0
                                      ? std::clamp(distance + kInside, -kFailed, kFailed)
                                      : failed);
    return value;
  }

  Minimisation::Value at(std::span<const double> x) {
    std::vector<double> values;
    for (std::size_t i = 0; i < x.size(); ++i) values.push_back(problem_.knobs()[i].value(x[i]));
    if (const auto known = seen_.find(values); known != seen_.end()) return known->second;
    if (tuned_.evaluations >= around_) throw Enough();
    const Assessment one = problem_.assess(values);
    ++tuned_.evaluations;
    if (is_better(one, tuned_.best, problem_.goal())) tuned_.best = one;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    told_({tuned_.evaluations, most_, static_cast<double>(tuned_.evaluations) / std::max(seconds, 1e-9),
           &tuned_.best});
    return seen_.emplace(values, value_of(one)).first->second;
  }

  const Problem& problem_;
  std::int64_t most_, around_ = 0;
  const std::function<void(const TuneProgress&)>& told_;
  Tuned tuned_;
  double size_ = 1;  ///< of the goal
  std::map<std::vector<double>, Minimisation::Value> seen_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace

bool is_better(const Assessment& a, const Assessment& b, const Goal& goal) {
  if (a.is_feasible() != b.is_feasible()) return a.is_feasible();
  if (!a.is_feasible()) {
    if (a.failed != b.failed) return a.failed < b.failed;
    if (a.lateness != b.lateness) return a.lateness < b.lateness;
    if (missed(a) != missed(b)) return missed(a) < missed(b);
  }
  return goal.maximises ? a.goal > b.goal : a.goal < b.goal;
}

Tuned tune(const Problem& problem, std::int64_t evaluations,
           const std::function<void(const TuneProgress&)>& told) {
  return Searcher(problem, evaluations, told).run();
}

}  // namespace mixloop
