// SPDX-License-Identifier: MIT
#include "planner/itinerary.hpp"

#include <gtest/gtest.h>

#include "tests/planner/mechanisms.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using Eigen::Vector3d;

TEST(Itinerary, RunsLinesAndRestsInTurn) {
  const Path path = path_from(
      "{via: [{at: [0, 0, 0], dwell: 0.1 s}, {at: [1, 0, 0], duration: 0.2 s, dwell: 0.3 s}, {at: [1, 1, 0], "
      "duration: 0.4 s}]}",
      paper_robot());
  const Itinerary itinerary(path, 1000, 1);
  EXPECT_EQ(itinerary.steps(), 1000);
  EXPECT_EQ(itinerary.at(50).position, Vector3d(0, 0, 0));
  EXPECT_EQ(itinerary.at(200).position, Vector3d(0.5, 0, 0));
  EXPECT_EQ(itinerary.at(200).velocity, Vector3d(10, 0, 0));  // 2 S/T
  EXPECT_EQ(itinerary.at(450).position, Vector3d(1, 0, 0));
  EXPECT_EQ(itinerary.at(450).velocity, Vector3d(0, 0, 0));
  EXPECT_EQ(itinerary.at(800).position, Vector3d(1, 0.5, 0));
  EXPECT_EQ(itinerary.at(1000).position, Vector3d(1, 1, 0));
}

TEST(Itinerary, GoesThereAndBackWithTheSameRests) {
  const Path path = path_from(
      "{via: [{at: [0, 0, 0]}, {at: [1, 0, 0], duration: 0.2 s, dwell: 0.1 s}, {at: [1, 1, 0], duration: 0.4 "
      "s, dwell: 0.3 s}], repeat: 3}",
      paper_robot());
  const Itinerary itinerary(path, 1000, 2);
  const std::int64_t lap = 2 * (200 + 100 + 400 + 300 + 400 + 100 + 200);
  EXPECT_EQ(itinerary.lap_steps(), lap);
  EXPECT_EQ(itinerary.steps(), 3 * lap);
  for (int k = 0; k <= lap / 2;
       ++k) {  // the way back mirrors the way there about the middle of the last rest
    const PathPoint there = itinerary.at(k), back = itinerary.at(static_cast<double>(lap - k));
    EXPECT_LT((there.position - back.position).norm(), 1e-15);
    EXPECT_LT((there.velocity + back.velocity).norm(), 1e-13);
    EXPECT_LT((there.acceleration - back.acceleration).norm(), 1e-12);
    EXPECT_EQ(itinerary.at(static_cast<double>(k + 2 * lap)).position, there.position);
  }
  EXPECT_EQ(itinerary.at(static_cast<double>(3 * lap)).position, Vector3d(0, 0, 0));
}

// k / n of a line is the same number whatever the stages, and ends are exact.
TEST(Itinerary, GivesTheSameBytesAtATickForAnyNumberOfStages) {
  const Path path = path_from(kPaperPath, paper_robot());
  const Itinerary ticks(path, 1000, 1), halves(path, 1000, 2), sixths(path, 1000, 6);
  for (int k = 0; k <= 1000; ++k) {
    EXPECT_EQ(ticks.at(k).position, halves.at(2 * k).position);
    EXPECT_EQ(ticks.at(k).acceleration, sixths.at(6 * k).acceleration);
  }
  EXPECT_EQ(ticks.at(0).position, Vector3d(0.3, 0, 0.8));
  EXPECT_EQ(ticks.at(1000).position, Vector3d(-0.3, 0.4, 0.3));
}

TEST(Itinerary, RefusesDurationsOffTheGrid) {
  const auto model = paper_robot();
  const auto refused = [&](const std::string& text, double rate) {
    return input_error([&] { Itinerary(path_from(text, model), rate, 1); });
  };
  const std::string line = "{line: {from: [0, 0, 0], to: [1, 0, 0]}, duration: ";
  auto error = refused(line + "0.9995 s}", 1000);
  EXPECT_EQ(error->code, "off_grid");
  EXPECT_EQ(to_string(error->place), "path.yaml:1:30");
  EXPECT_NE(error->message.find("999.5 ticks"), std::string::npos) << error->message;
  EXPECT_EQ(refused(line + "1 ps}", 1000)->code, "unknown_unit");
  EXPECT_EQ(refused(line + "1 ns}", 1000)->code, "off_grid");
  EXPECT_EQ(refused(line + "10000000 s}", 1000)->code, "too_large");
  EXPECT_EQ(refused("{via: [{at: [0, 0, 0]}, {at: [1, 1, 1], duration: 1 s, dwell: 0.5 ms}]}", 1000)->code,
            "off_grid");
  EXPECT_NO_THROW(Itinerary(path_from(line + "0.6 s}", model), 1000, 1));
  EXPECT_NO_THROW(Itinerary(path_from(line + "0.3 s}", model), 10.0 / 3, 1));
}

TEST(Itinerary, SaysWhereAStepIs) {
  const Itinerary itinerary(
      path_from("{via: [{at: [0, 0, 0]}, {at: [1, 0, 0], duration: 1 s, dwell: 1 s}], repeat: 2}",
                paper_robot()),
      1000, 1);
  EXPECT_EQ(itinerary.describe(500),
            "0.5 of the line from (0, 0, 0) to (1, 0, 0) m, at (0.5, 0, 0) m, lap 1 of 2");
  EXPECT_EQ(itinerary.describe(4500), "at rest at (1, 0, 0) m, lap 2 of 2");
  EXPECT_EQ(to_string(itinerary.place(500)), "path.yaml:1:25");
}

}  // namespace
}  // namespace mixloop
