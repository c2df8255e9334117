// SPDX-License-Identifier: MIT
#include "tuning/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <set>

#include "notation/long_work.hpp"
#include "notation/utf8.hpp"
#include "tuning/side_by_side.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kTogether = Engine::kTogether;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::vector<Knob> knobs_of(const TuneRequest& request) {
  const auto& file = request.sweep.experiment;
  const NodePtr document = experiment_document(read_document(file), file, request.sweep.overrides);
  return read_knobs(request.over, document, load_scenes(document, file, request.sweep.overrides));
}

/// What is tuned stands first in the design, as varied, each with the one value that it has.
SweepRequest with_knobs(SweepRequest request, const std::vector<Knob>& knobs) {
  std::vector<Variation> varied;
  for (const Knob& knob : knobs) varied.push_back(knob.as_variation());
  auto& others = request.design.varied;
  others.insert(others.begin(), varied.begin(), varied.end());
  return request;
}

bool failed(const Outcome& outcome) { return outcome.end > RunEnd::missed; }

}  // namespace

/// A run of a candidate: what it came to, and its loop along the path.
struct Problem::Run {
  std::vector<double> criteria;
  bool failed = false;
  double lateness = 0;
  RunEnd end = RunEnd::held;
  std::optional<Survey> survey;
};

Problem::Problem(const TuneRequest& request, int threads, std::function<bool()> goes_on)
    : knobs_(knobs_of(request)),
      setup_(with_knobs(request.sweep, knobs_), request.evaluation),
      telling_{.columns = Columns(setup_.experiment(), request.sweep.settled_within.has_value()),
               .settled_within = request.sweep.settled_within},
      criteria_(telling_.columns, setup_.experiment()),
      goal_(read_goal(request.goal, request.maximises, criteria_)),
      share_(request.share),
      poses_(request.poses),
      threads_(threads),
      goes_on_(std::move(goes_on)) {
  for (const std::string& text : request.subject)
    for (Bound& bound : read_bounds(text, criteria_)) bounds_.push_back(std::move(bound));
  std::set<std::size_t> asked(goal_.criteria.begin(), goal_.criteria.end());
  for (const Bound& bound : bounds_) asked.insert(bound.criterion);
  for (const std::size_t one : asked)
    if (criteria_[one].margin) margins_.push_back(one);
  require_open_knobs();
  std::vector<double> now;
  for (const Knob& knob : knobs_) now.push_back(knob.now);
  const std::vector<Run> runs = runs_of(now);
  const Assessment first = judged(now, runs);
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    Bound& bound = bounds_[i];
    if (!bound.times_now) continue;
    bound.limit = first.bounded[i] * *bound.times_now;
    if (!std::isfinite(bound.limit))
      throw InputError("out_of_range", bound.place,
                       fmt::format("{} of the experiment as it stands is {}; expected a bound in numbers",
                                   criteria_[bound.criterion].name,
                                   first.failed > 0                    ? "not there, since runs fail"
                                   : criteria_[bound.criterion].margin ? "without limit"
                                                                       : "never measured"));
  }
  before_ = judged(now, runs);
}

/// A number that may be no other one, a count for instance, would make all candidates refused.
void Problem::require_open_knobs() const {
  std::vector<double> values;
  for (const Knob& knob : knobs_) values.push_back(knob.now);
  for (std::size_t i = 0; i < knobs_.size(); ++i) {
    std::vector<double> other = values;
    const double share = knobs_[i].share(values[i]);
    other[i] = knobs_[i].value(share > 0.5 ? share - 1e-3 : share + 1e-3);
    try {
      setup_.prepared(0, overrides(other));
    } catch (const InputError& error) {
      try {
        setup_.prepared(0, overrides(values));
      } catch (const InputError&) {
        throw error;
      }
      throw InputError(error.code, knobs_[i].place,
                       fmt::format("{} can't be tuned, since not every number between its ends will do; "
                                   "with {} {}",
                                   in_quotes(knobs_[i].key), knobs_[i].text_of(other[i]), error.message));
    }
  }
}

std::vector<Override> Problem::overrides(const std::vector<double>& values) const {
  std::vector<Override> overrides;
  for (std::size_t i = 0; i < knobs_.size(); ++i)
    overrides.push_back({knobs_[i].key, knobs_[i].text_of(values[i])});
  return overrides;
}

std::vector<Problem::Run> Problem::gone_through(const std::vector<std::vector<Override>>& overrides) const {
  std::vector<Run> runs(overrides.size());
  const auto diverged_at = static_cast<std::size_t>(
      std::ranges::find(telling_.columns.all(), "diverged_at", &Columns::Column::name) -
      telling_.columns.all().begin());
  const auto go_through = [&](std::size_t batch) {
    const std::size_t first = batch * kTogether, count = std::min(kTogether, runs.size() - first);
    if (!goes_on_()) throw Interrupted("interrupted while tuning");
    std::vector<double> length(count, 1);
    const auto prepare = [&](std::int64_t run) {
      const auto i = static_cast<std::size_t>(run);
      PreparedRun prepared = setup_.prepared(run, overrides[i]);
      const double rate = prepared.experiment.rate_hz;
      length[i - first] = static_cast<double>(std::max<std::int64_t>(prepared.plan->ticks(), 1)) / rate;
      if (!margins_.empty()) try {
          runs[i].survey = survey(prepared.experiment, *prepared.plan, poses_);
        } catch (const RunFault&) {  // nothing to linearise: no margin is known
        }
      return prepared;
    };
    const auto outcomes = run_batch(prepare, telling_, engine_, static_cast<std::int64_t>(first),
                                    static_cast<std::int64_t>(count), [] { return true; });
    for (std::size_t i = 0; i < count; ++i) {
      Run& run = runs[first + i];
      run.end = outcomes[i].end;
      run.criteria = outcomes[i].values;
      run.criteria.resize(criteria_.size(), kNeverMeasured);
      const double end = outcomes[i].values[diverged_at];
      run.failed = failed(outcomes[i]) || !std::isnan(end);
      if (run.failed) run.lateness = std::isnan(end) ? 1 : std::clamp(1 - end / length[i], 0.0, 1.0);
    }
  };
  side_by_side((runs.size() + kTogether - 1) / kTogether, threads_, go_through);
  return runs;
}

void Problem::add_margins(std::vector<Run>& runs) const {
  struct Task {
    std::size_t run, pose, margin;
    double value = kNeverMeasured;
  };
  std::vector<Task> tasks;
  for (std::size_t run = 0; run < runs.size(); ++run)
    for (std::size_t margin = 0; margin < margins_.size() && runs[run].survey; ++margin) {
      const std::size_t poses =
          criteria_[margins_[margin]].margin->is_along_path() ? runs[run].survey->loops.size() : 1;
      for (std::size_t pose = 0; pose < poses; ++pose) tasks.push_back({run, pose, margin});
    }
  // The least that is known of each; what is known to be no less isn't looked for, which changes no bit.
  std::vector<std::atomic<double>> narrowest_so_far(runs.size() * margins_.size());
  for (auto& one : narrowest_so_far) one = kInfinite;
  side_by_side(tasks.size(), threads_, [&](std::size_t i) {
    Task& task = tasks[i];
    if (!goes_on_()) throw Interrupted("interrupted while tuning");
    const Margin& margin = *criteria_[margins_[task.margin]].margin;
    const Survey& survey = *runs[task.run].survey;
    const LinearLoop& loop = survey.loops[task.pose];
    std::atomic<double>& known = narrowest_so_far[task.run * margins_.size() + task.margin];
    task.value = margin.is_along_path() ? margin_at(margin, loop, survey.sampling, known)
                                        : margin_at_start(margin, limits_of(loop, survey.sampling));
    for (double least = known; task.value < least && !known.compare_exchange_weak(least, task.value);) {
    }
  });
  for (const Task& task : tasks) {
    double& narrowest = runs[task.run].criteria[margins_[task.margin]];
    const bool is_radius = criteria_[margins_[task.margin]].margin->kind == Margin::Kind::spectral_radius;
    if (std::isnan(narrowest) || (is_radius ? task.value > narrowest : task.value < narrowest))
      narrowest = task.value;
  }
}

/// The value that the share of the runs doesn't pass, upwards or downwards: a run's own.
double Problem::worst(const std::vector<Run>& runs, std::size_t criterion, bool upwards) const {
  const bool is_margin = criteria_[criterion].margin.has_value();
  std::vector<double> values;
  for (const Run& run : runs) {
    const double value = run.criteria[criterion];
    const bool known = !std::isnan(value) && (is_margin || !run.failed);
    values.push_back(!known ? kInfinite : upwards ? value : -value);
  }
  const double rank = std::ceil(share_ * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::ranges::nth_element(values, at);
  return upwards ? *at : -*at;
}

std::vector<Problem::Run> Problem::runs_of(const std::vector<double>& values) const {
  const std::vector<Override> mine = overrides(values);
  std::vector<std::vector<Override>> all;
  for (std::int64_t run = 0; run < this->runs(); ++run) {
    all.push_back(setup_.design().overrides(run));
    std::ranges::copy(mine, all.back().begin());
  }
  std::vector<Run> runs = gone_through(all);
  add_margins(runs);
  return runs;
}

Assessment Problem::assess(const std::vector<double>& values) const {
  return judged(values, runs_of(values));
}

Assessment Problem::judged(const std::vector<double>& values, const std::vector<Run>& runs) const {
  Assessment assessment{.values = values, .goal = 0, .bounded = {}, .held = {}, .distance = {}};
  for (const Run& run : runs) {
    assessment.failed += run.failed ? 1 : 0;
    assessment.lateness += run.lateness;
  }
  assessment.goal = goal_.maximises ? kInfinite : -kInfinite;
  for (const std::size_t one : goal_.criteria) {
    const double value = worst(runs, one, !goal_.maximises);
    assessment.goal = goal_.maximises ? std::min(assessment.goal, value) : std::max(assessment.goal, value);
  }
  assessment.is_known = assessment.goal != (goal_.maximises ? -kInfinite : kInfinite);
  for (const Bound& bound : bounds_) {
    const double value = worst(runs, bound.criterion, bound.is_upper);
    const double size = std::abs(bound.limit) > 0 ? std::abs(bound.limit) : 1;
    assessment.bounded.push_back(value);
    assessment.held.push_back(bound.holds(value));
    assessment.distance.push_back((bound.is_upper ? value - bound.limit : bound.limit - value) / size);
  }
  return assessment;
}

Problem::Alone Problem::alone(const std::vector<double>& values) const {
  std::vector<Run> runs = gone_through({overrides(values)});
  add_margins(runs);
  return {std::move(runs[0].criteria), runs[0].end};
}

}  // namespace mixloop
