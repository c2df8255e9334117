// SPDX-License-Identifier: MIT
#include "sweep/reduction/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "notation/long_work.hpp"
#include "sweep/reduction/ranks.hpp"

namespace mixloop {
namespace {

using Kind = Variable::Kind;

constexpr std::size_t kBars = 60;         // of a histogram
constexpr std::size_t kMostCells = 40;    // of a list that has a cell each
constexpr std::size_t kMostMetrics = 12;  // that colour maps
constexpr std::size_t kMostPlaced = 8;    // entries that maps have
constexpr double kMostNumbers = 1.2e6;    // in the cells of all maps
constexpr std::size_t kMostSide = 40, kLeastSide = 8;
constexpr std::int64_t kFewestDraws = 64, kDrawsAClass = 16;
constexpr std::size_t kMostClasses = 100, kClassesOfMany = 10, kMany = 100;  // entries
constexpr std::size_t kWorst = 10;

/// The runs as numbers of the variables.
EachRun as_variables(const KeptSweep& sweep, const EachRun& each, const char* what) {
  return [&sweep, &each, what](const auto& told) {
    VariableReader reader(sweep);
    each([&](const Outcome& outcome) {
      told(reader.read(outcome));
      work_goes_on(what, outcome.run, sweep.design.runs());
    });
    work_goes_on(what, sweep.design.runs(), sweep.design.runs());
  };
}

/// As many cells as `inner`, but for what has few values of its own.
Axis axis_of(const Variable& variable, const Variation* listed, std::span<const double> sorted,
             std::size_t inner) {
  if (!variable.words.empty()) return words_axis(std::min(variable.words.size(), kMostCells));
  if (variable.kind == Kind::listed) {
    Axis axis = values_axis(listed->numbers);
    if (axis.inner <= kMostCells) return axis;
  }
  return even_axis(sorted, inner);
}

/// What is known of each variable once all values of it were seen together.
struct Known {
  Reduction reduction;
  std::vector<Ranks> ranks;
};

Known known_of(const KeptSweep& sweep, const EachRun& each) {
  Known known;
  auto& variables = known.reduction.variables = variables_of(sweep);
  known.ranks.resize(variables.size());
  const auto& variations = sweep.design.variations();
  known.reduction.ends =
      statistics_of(variables.size(), as_variables(sweep, each, "reading the runs"),
                    [&](std::size_t i, std::vector<double>& values) {
                      std::ranges::sort(values);
                      known.ranks[i] = Ranks(values);
                      variables[i].axis = axis_of(
                          variables[i], i < variations.size() ? &variations[i] : nullptr, values, kBars);
                      variables[i].histogram.resize(variables[i].axis.cells());
                    });
  for (std::size_t i = 0; i < variables.size(); ++i)
    variables[i].statistics = known.reduction.ends.columns[i];
  for (std::size_t i = variations.size(); i < variables.size(); ++i)
    if (variables[i].varies() && variables[i].name != "ticks" &&
        known.reduction.metrics.size() < kMostMetrics)
      known.reduction.metrics.push_back(i);
  return known;
}

/// The classes of an entry, of which the correlation ratio tells.
struct Classes {
  std::size_t count = 1;
  bool are_cells = false;

  Classes(const Variable& variable, std::int64_t draws, std::size_t most) {
    const auto finest = std::clamp(static_cast<std::size_t>(draws / kDrawsAClass), std::size_t{4}, most);
    are_cells = variable.axis.kind != Axis::Kind::even;
    count = are_cells ? variable.axis.cells() : finest;
  }
  std::size_t of(const Variable& variable, double value, double share_below) const {
    if (are_cells) return variable.axis.cell_of(value);
    return std::min(static_cast<std::size_t>(share_below * static_cast<double>(count)), count - 1);
  }
};

class WorstRuns {
 public:
  void add(const Outcome& outcome, double value, bool least_is_worst) {
    const auto is_worse = [&](const WorstRun& one) {
      return least_is_worst ? value < one.value : value > one.value;
    };
    if (std::isnan(value) || (all_.size() == kWorst && !is_worse(all_.back()))) return;
    all_.insert(std::ranges::find_if(all_, is_worse), {outcome.run, value, outcome.end});
    if (all_.size() > kWorst) all_.pop_back();
  }
  const std::vector<WorstRun>& all() const { return all_; }

 private:
  std::vector<WorstRun> all_;
};

/// Histograms, influences and worst runs: one pass.
class Comparison {
 public:
  Comparison(const KeptSweep& sweep, Known& known)
      : sweep_(sweep), known_(known), draws_(draws(sweep, known)), worst_(metrics().size()) {
    for (std::size_t i = 0; i < sweep.design.variations().size(); ++i)
      if (variables()[i].varies()) entries_.push_back(i);
    std::vector<std::size_t> counts;
    const std::size_t most = entries_.size() > kMany ? kClassesOfMany : kMostClasses;
    for (const std::size_t i : entries_)
      counts.push_back(classes_.emplace_back(variables()[i], draws_, most).count);
    influences_.emplace(counts, 2 * metrics().size(), is_drawn());
    correlations_.resize(entries_.size() * metrics().size());
    class_.resize(entries_.size());
    share_.resize(entries_.size());
    value_.resize(2 * metrics().size());
  }

  void add(const Outcome& run) {
    for (std::size_t i = 0; i < variables().size(); ++i)
      if (!std::isnan(run.values[i])) ++variables()[i].histogram[variables()[i].axis.cell_of(run.values[i])];
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const double value = run.values[entries_[i]];
      share_[i] = known_.ranks[entries_[i]].share_below(value);
      class_[i] = classes_[i].of(variables()[entries_[i]], value, share_[i]);
    }
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const Variable& metric = variables()[metrics()[m]];
      const double value = run.values[metrics()[m]];
      value_[m] = (value - metric.statistics.mean) / metric.statistics.deviation;
      if (metric.kind != Kind::held) worst_[m].add(run, value, metric.least_is_worst);
      const double below = known_.ranks[metrics()[m]].share_below(value);
      value_[metrics().size() + m] = below - 0.5;
      for (std::size_t i = 0; i < entries_.size(); ++i)
        correlations_[i * metrics().size() + m].add(share_[i] - 0.5, below - 0.5);
    }
    influences_->add(sweep_.design.draw_of(run.run), class_, value_);
  }

  void tell(Reduction& reduction) const {
    const bool covers_a_corner = sweep_.design.varied() > 0 && reduction.ends.runs < sweep_.design.runs();
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      using Missing = MetricInfluence::Missing;
      MetricInfluence one{.metric = metrics()[m], .runs = variables()[metrics()[m]].statistics.measured};
      const double measured =
          static_cast<double>(one.runs) / static_cast<double>(std::max<std::int64_t>(reduction.ends.runs, 1));
      if (covers_a_corner) one.missing = Missing::partly_run;
      if (is_drawn() && measured * static_cast<double>(draws_) < kFewestDraws) one.missing = Missing::too_few;
      for (std::size_t i = 0; i < entries_.size() && one.missing == Missing::none; ++i)
        one.entries.push_back(
            {entries_[i], classes_[i].count, influences_->of(i, m), influences_->of(i, metrics().size() + m),
             variables()[entries_[i]].words.empty() ? correlations_[i * metrics().size() + m].value()
                                                    : kNeverMeasured});
      reduction.influences.push_back(std::move(one));
      reduction.worst.push_back(worst_[m].all());
    }
  }

 private:
  static std::int64_t draws(const KeptSweep& sweep, const Known& known) {
    return std::min(sweep.design.draws(), known.reduction.ends.runs);
  }
  bool is_drawn() const { return !sweep_.spread.empty(); }
  std::vector<Variable>& variables() const { return known_.reduction.variables; }
  const std::vector<std::size_t>& metrics() const { return known_.reduction.metrics; }

  const KeptSweep& sweep_;
  Known& known_;
  std::int64_t draws_;
  std::vector<std::size_t> entries_;  ///< that vary
  std::vector<Classes> classes_;
  std::optional<Influences> influences_;
  std::vector<Correlation> correlations_;
  std::vector<WorstRuns> worst_;
  std::vector<std::size_t> class_;
  std::vector<double> share_;  ///< of the run in hand: of the entries' values, those below
  std::vector<double> value_;  ///< the metrics, then their ranks
};

/// The entries that maps have, in their order: all, or of many those that move some metric most.
std::vector<std::size_t> placed_of(const Reduction& reduction) {
  std::vector<std::size_t> entries;
  std::vector<double> most(reduction.variables.size());
  for (std::size_t i = 0; i < reduction.variables.size(); ++i)
    if (reduction.variables[i].is_entry() && reduction.variables[i].varies()) entries.push_back(i);
  for (const auto& metric : reduction.influences)
    for (const auto& one : metric.entries) most[one.entry] = std::max(most[one.entry], one.influence.share);
  std::ranges::stable_sort(entries, [&](std::size_t a, std::size_t b) { return most[a] > most[b]; });
  entries.resize(std::min(entries.size(), kMostPlaced));
  std::ranges::sort(entries);
  return entries;
}

/// As many cells along a side as all maps together can have, and no more than the runs fill.
std::size_t side_of(const Reduction& reduction) {
  const double entries = static_cast<double>(reduction.placed.size());
  const double metrics = static_cast<double>(reduction.metrics.size());
  const double maps = entries * (entries - 1) / 2 + entries * metrics;
  const double cells = std::min(kMostNumbers / std::max(maps * (1 + 3 * metrics), 1.0),
                                static_cast<double>(reduction.ends.runs) / 4);
  return std::clamp(static_cast<std::size_t>(std::sqrt(cells)), kLeastSide, kMostSide);
}

void lay_out_maps(Reduction& reduction) {
  const std::size_t side = side_of(reduction);
  for (const Variable& variable : reduction.variables) {
    Axis& axis = reduction.axes.emplace_back(variable.axis);
    if (axis.kind == Axis::Kind::even) axis.inner = std::min(axis.inner, side);
  }
  std::vector<bool> least;
  for (const std::size_t metric : reduction.metrics)
    least.push_back(reduction.variables[metric].least_is_worst);
  const auto add = [&](std::size_t x, std::size_t y) {
    reduction.maps.push_back({x, y, Density(reduction.axes[x].cells(), reduction.axes[y].cells(), least)});
  };
  for (std::size_t i = 0; i < reduction.placed.size(); ++i) {
    for (std::size_t j = i + 1; j < reduction.placed.size(); ++j)
      add(reduction.placed[i], reduction.placed[j]);
    for (const std::size_t metric : reduction.metrics) add(reduction.placed[i], metric);
  }
}

void fill_maps(Reduction& reduction, const EachRun& each_variable) {
  std::vector<std::size_t> cell(reduction.variables.size());
  std::vector<double> values(reduction.metrics.size());
  each_variable([&](const Outcome& run) {
    for (std::size_t m = 0; m < values.size(); ++m) values[m] = run.values[reduction.metrics[m]];
    for (const auto* variables : {&reduction.placed, &reduction.metrics})
      for (const std::size_t i : *variables)
        if (!std::isnan(run.values[i])) cell[i] = reduction.axes[i].cell_of(run.values[i]);
    for (DensityMap& map : reduction.maps)
      if (!std::isnan(run.values[map.y])) map.density.add(cell[map.x], cell[map.y], run.run, values);
  });
}

}  // namespace

Reduction reduced(const KeptSweep& sweep, const EachRun& each) {
  Known known = known_of(sweep, each);
  Comparison comparison(sweep, known);
  as_variables(sweep, each, "comparing the runs")([&](const Outcome& run) { comparison.add(run); });
  Reduction reduction = known.reduction;
  comparison.tell(reduction);
  reduction.placed = placed_of(reduction);
  lay_out_maps(reduction);
  fill_maps(reduction, as_variables(sweep, each, "placing the runs"));
  return reduction;
}

}  // namespace mixloop
