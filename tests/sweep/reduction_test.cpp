// SPDX-License-Identifier: MIT
// What a page draws of a sweep, beside the runs themselves.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "sweep/reduction/reduction.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

/// Two entries that are drawn and one of words; a metric of the first, one that is seldom measured.
KeptSweep three_entries(std::int64_t draws) {
  return {.name = "three",
          .called = "mixloop sweep three.yaml",
          .experiment = "three.yaml",
          .overrides = {},
          .design = Design({.varied = {parse_varied("law=pd,torque")},
                            .sampled = {parse_sampled("mass=normal(5 kg, 1 kg)"),
                                        parse_sampled("delay=uniform(0, 300 us)")},
                            .draws = draws}),
          .spread = "latin",
          .columns = {{"error", "m"}, {"diverged_at", "s"}, {"ticks", "1"}},
          .sha256 = ""};
}

double error_of(const std::vector<RunValue>& x) {
  return 1e-3 * (x[1].number + 0.5 * x[0].number) + 1e-7 * x[2].number;
}

/// Each tenth one diverges, without an error.
Outcome outcome_of(const KeptSweep& sweep, std::int64_t run) {
  if (run % 10 == 9)
    return {.run = run,
            .end = RunEnd::diverged,
            .values = {kNeverMeasured, 0.1 + 1e-4 * static_cast<double>(run % 1000), 12}};
  return {.run = run, .values = {error_of(sweep.design.values(run)), kNeverMeasured, 1000}};
}

EachRun runs_of(const KeptSweep& sweep, std::int64_t count) {
  return [&sweep, count](const auto& told) {
    for (std::int64_t run = 0; run < count; ++run) told(outcome_of(sweep, run));
  };
}

std::int64_t sum(const std::vector<std::int64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

class SweepReduction : public testing::Test {
 protected:
  const KeptSweep sweep = three_entries(1000);
  const Reduction all = reduced(sweep, runs_of(sweep, 2000));
};

TEST_F(SweepReduction, HasEachRunOnceInEveryHistogramAndMap) {
  ASSERT_EQ(all.variables.size(), 7U);
  for (const Variable& variable : all.variables)
    EXPECT_EQ(sum(variable.histogram), variable.statistics.measured) << variable.name;
  EXPECT_THAT(all.variables[0].histogram, ElementsAre(1000, 1000));
  EXPECT_EQ(all.variables[3].statistics.measured, 1800);
  EXPECT_THAT(all.metrics, ElementsAre(3, 4, 6)) << "error, diverged_at, not held; ticks is a mere count";
  EXPECT_EQ(all.maps.size(), 3U + 3U * 3U);
  for (const DensityMap& map : all.maps) {
    std::int64_t runs = 0, measured = 0;
    for (std::size_t cell = 0; cell < map.density.cells(); ++cell) {
      runs += map.density.runs(cell);
      measured += map.density.metric(cell, 0).measured;
    }
    EXPECT_EQ(runs, all.variables[map.y].statistics.measured);
    EXPECT_EQ(measured, all.variables[map.y].is_entry() || map.y == 6 ? 1800 : map.y == 3 ? 1800 : 0);
  }
}

TEST_F(SweepReduction, HasOfEachCellTheMeanAndTheWorstRun) {
  const auto at =
      std::ranges::find_if(all.maps, [](const DensityMap& map) { return map.x == 1 && map.y == 2; });
  ASSERT_NE(at, all.maps.end());
  std::vector<std::vector<std::int64_t>> runs(at->density.cells());
  for (std::int64_t run = 0; run < 2000; ++run) {
    const auto values = sweep.design.values(run);
    runs[all.axes[1].cell_of(values[1].number) * all.axes[2].cells() + all.axes[2].cell_of(values[2].number)]
        .push_back(run);
  }
  for (std::size_t cell = 0; cell < runs.size(); ++cell) {
    ASSERT_EQ(at->density.runs(cell), std::ssize(runs[cell]));
    double total = 0, most = -1;
    std::int64_t measured = 0, worst = -1;
    for (const std::int64_t run : runs[cell]) {
      const double error = outcome_of(sweep, run).values[0];
      if (std::isnan(error)) continue;
      total += error, ++measured;
      if (error > most) most = error, worst = run;
    }
    const Density::Metric& metric = at->density.metric(cell, 0);
    ASSERT_EQ(metric.measured, measured);
    if (measured == 0) continue;
    EXPECT_NEAR(metric.mean(), total / static_cast<double>(measured), 1e-15);
    EXPECT_EQ(metric.worst, most);
    EXPECT_EQ(metric.run, worst);
  }
}

TEST_F(SweepReduction, TellsTheWorstRunsInOrderTheEarliestOfThoseThatDiverged) {
  const auto& errors = all.worst[0];
  ASSERT_EQ(errors.size(), 10U);
  EXPECT_EQ(errors[0].run, all.variables[3].statistics.run_of_most);
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LE(errors[i].value, errors[i - 1].value);
  EXPECT_EQ(all.worst[1][0].run, 9);
  EXPECT_EQ(all.worst[1][0].end, RunEnd::diverged);
  EXPECT_EQ(all.worst[1][1].run, 1009) << "as early, and later in the table";
  EXPECT_TRUE(all.worst[2].empty()) << "held or not has no worst";
}

TEST_F(SweepReduction, SaysWhatMovesWhat) {
  const MetricInfluence& error = all.influences[0];
  EXPECT_EQ(error.missing, MetricInfluence::Missing::none);
  EXPECT_EQ(error.runs, 1800);
  // Variances 0.25 / 4 of the words' numbers, 1 of the mass, (300 1e-4)^2 / 12 of the delay.
  const double whole = 0.0625 + 1 + 7.5e-5;
  ASSERT_EQ(error.entries.size(), 3U);
  EXPECT_NEAR(error.entries[0].influence.share, 0.0625 / whole, 0.02);
  EXPECT_NEAR(error.entries[1].influence.share, 1 / whole, 0.03);
  EXPECT_NEAR(error.entries[2].influence.share, 0, error.entries[2].influence.doubt + 0.01);
  EXPECT_TRUE(std::isnan(error.entries[0].rank_correlation)) << "words have no order";
  EXPECT_GT(error.entries[1].rank_correlation, 0.9);
  EXPECT_GT(error.entries[1].on_ranks.share, 0.85);
  EXPECT_LT(error.entries[0].on_ranks.share, 0.1);
  EXPECT_EQ(all.influences[1].missing, MetricInfluence::Missing::none);
}

TEST(Reduction, OfACornerOfAGridOrAFewDrawsSaysThatItCannotTell) {
  using Missing = MetricInfluence::Missing;
  const KeptSweep sweep = three_entries(1000);
  EXPECT_EQ(reduced(sweep, runs_of(sweep, 1500)).influences[0].missing, Missing::partly_run);
  const KeptSweep few = three_entries(40);
  EXPECT_EQ(reduced(few, runs_of(few, 80)).influences[0].missing, Missing::too_few);
}

TEST(Reduction, OfOneRunHasNothingThatVaries) {
  const KeptSweep sweep = three_entries(1000);
  const Reduction one = reduced(sweep, runs_of(sweep, 1));
  EXPECT_TRUE(one.metrics.empty());
  EXPECT_TRUE(one.maps.empty());
}

// 40 entries, 12 metrics: what is held doesn't grow with either, nor with the runs.
TEST(Reduction, OfManyEntriesPlacesThoseThatMoveMost) {
  Design::Settings settings{.draws = 3000};
  for (int i = 0; i < 40; ++i)
    settings.sampled.push_back(parse_sampled("x" + std::to_string(i) + "=uniform(0, 1)"));
  KeptSweep sweep{.name = "many",
                  .called = "",
                  .experiment = "many.yaml",
                  .overrides = {},
                  .design = Design(settings),
                  .spread = "latin",
                  .columns = {},
                  .sha256 = ""};
  for (int i = 0; i < 14; ++i) sweep.columns.push_back({"y" + std::to_string(i), "1"});
  const Reduction many = reduced(sweep, [&](const auto& told) {
    std::vector<double> x(40);
    for (std::int64_t run = 0; run < 3000; ++run) {
      sweep.design.numbers(run, x);
      told(Outcome{.run = run, .values = std::vector<double>(14, x[11] + 0.5 * x[33])});
    }
  });
  EXPECT_EQ(many.metrics.size(), 12U);
  EXPECT_EQ(many.placed.size(), 8U);
  EXPECT_THAT(many.placed, testing::IsSupersetOf({11U, 33U}));
  std::size_t numbers = 0;
  for (const DensityMap& map : many.maps) numbers += map.density.cells() * (1 + 3 * many.metrics.size());
  EXPECT_LT(numbers, 2'000'000U);
}

TEST(Axis, ReachesHalfAsFarAgainAsTheMiddleAndHasCellsForWhatLiesOutside) {
  std::vector<double> sorted;
  for (int i = 0; i <= 1000; ++i) sorted.push_back(i);
  sorted.back() = 1e6;
  const Axis axis = even_axis(sorted, 50);
  EXPECT_EQ(axis.from, 0);
  EXPECT_EQ(axis.to, 990 + 0.5 * 980);
  EXPECT_EQ(axis.cells(), 52U);
  EXPECT_EQ(axis.cell_of(-1), 0U);
  EXPECT_EQ(axis.cell_of(0), 1U);
  EXPECT_EQ(axis.cell_of(axis.to), 50U);
  EXPECT_EQ(axis.cell_of(1e6), 51U);
}

TEST(Axis, OfWhatReachesFarUpIsByTheLogarithm) {
  std::vector<double> sorted;
  for (int i = 0; i <= 1000; ++i) sorted.push_back(std::pow(10.0, 1e-9 * std::pow(i, 3)));  // 1 to 10
  for (double& one : sorted) one = std::pow(one, 3);
  const Axis axis = even_axis(sorted, 30);
  EXPECT_TRUE(axis.logarithmic);
  EXPECT_EQ(axis.from, 1);
  EXPECT_EQ(axis.to, 1000);
  EXPECT_EQ(axis.cell_of(1), 1U);
  EXPECT_EQ(axis.cell_of(10.001), 11U);
  EXPECT_EQ(axis.cell_of(1000), 30U);
}

TEST(Axis, OfAGrainHasCellsOfEquallyManyGrains) {
  std::vector<double> sorted;
  for (int i = 0; i < 170; ++i) sorted.push_back(0.48 + 0.001 * (i / 10));
  const Axis axis = even_axis(sorted, 60);
  EXPECT_EQ(axis.inner, 17U);
  std::vector<std::size_t> counts(axis.cells());
  for (const double one : sorted) ++counts[axis.cell_of(one)];
  for (std::size_t i = 1; i <= 17; ++i) EXPECT_EQ(counts[i], 10U);
  // With room for six cells, three of them in each.
  const Axis coarse = even_axis(sorted, 6);
  EXPECT_EQ(coarse.inner, 6U);
  EXPECT_EQ(coarse.cell_of(0.482), 1U);
  EXPECT_EQ(coarse.cell_of(0.483), 2U);
  EXPECT_EQ(coarse.cell_of(0.496), 6U);
}

TEST(Axis, OfAListHasACellAValueInAscendingOrder) {
  const Axis axis = values_axis({5, 0, 2, 2});
  EXPECT_THAT(axis.values, ElementsAre(0, 2, 5));
  EXPECT_EQ(axis.cell_of(2), 1U);
  const Axis one = even_axis(std::vector<double>{3, 3, 3}, 60);
  EXPECT_EQ(one.cell_of(3), 1U);
}

}  // namespace
}  // namespace mixloop
