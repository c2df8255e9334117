// SPDX-License-Identifier: MIT
// What is told of a table's columns.
#include <gmock/gmock.h>

#include "sweep/statistics.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

TEST(SweepStatistics, OfATableOfAHundredAndARunThatDivergedAndOneThatNeverWas) {
  SweepRequest request;
  request.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
  request.design.varied = {parse_varied("seed=1..102:102")};
  request.expect = {{.share = 0.9, .expected = parse_document("{max_position_error: 92 mm}", "")},
                    {.share = 1, .expected = parse_document("{max_position_error: 200 mm}", "")}};
  request.overrides = {{"limits.position_error", "300 mm"}};
  const Sweep sweep("test", request, Evaluation::interpreter, false);
  const std::size_t size = sweep.telling().columns.size();
  const EachRun each = [&](const auto& told) {
    for (std::int64_t run = 0; run < 102; ++run) {
      Outcome outcome{.run = run, .values = std::vector<double>(size, kNeverMeasured)};
      // 1 mm to 100 mm, the greatest in the middle.
      if (run < 100) outcome.values[0] = 1e-3 * static_cast<double>((run + 49) % 100 + 1);
      if (run == 100) outcome.end = RunEnd::diverged, outcome.values[size - 3] = 0.25;
      if (run == 101) outcome.end = RunEnd::refused, outcome.code = "negative_mass";
      told(outcome);
    }
  };
  const Statistics statistics = statistics_of(sweep, each);
  EXPECT_EQ(statistics.runs, 102);
  EXPECT_THAT(statistics.ends, ElementsAre(100, 0, 1, 0, 0, 1));
  EXPECT_EQ(statistics.first[5], 101);
  EXPECT_EQ(statistics.code[5], "negative_mass");
  const ColumnStatistics& errors = statistics.columns[0];
  EXPECT_EQ(errors.measured, 100);
  EXPECT_NEAR(errors.mean, 50.5e-3, 1e-15);
  EXPECT_NEAR(errors.deviation, 29.011491975882016e-3, 1e-15);  // sqrt(100 * 101 / 12)
  EXPECT_THAT(errors.quantiles, ElementsAre(50e-3, 90e-3, 99e-3, 100e-3));
  EXPECT_EQ(errors.run_of_most, 50);
  EXPECT_EQ(errors.run_of_least, 51);
  // 92 of 102 runs.
  EXPECT_EQ(statistics.bounds[0].held, 92);
  EXPECT_TRUE(statistics.bounds[0].is_held);
  EXPECT_FALSE(statistics.bounds[1].is_held) << "two of them weren't whole";
  EXPECT_EQ(statistics.bounds[1].worst, 101);
  EXPECT_THAT(statistics.bounds[1].missed, ElementsAre("it could not be run: negative_mass"));
}

}  // namespace
}  // namespace mixloop
