// SPDX-License-Identifier: MIT
// The search by itself, on functions whose least value is known.
#include "tuning/minimise.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace mixloop {
namespace {

/// The point nearest to (0.3, 0.8) of those with x + y <= 0.9: (0.2, 0.7), by hand.
class NearestPoint : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_minimise()) GTEST_SKIP() << "built without NLopt: package libnlopt-dev";
  }

  Minimisation problem() {
    return {.constraints = 1, .at = [this](std::span<const double> x) {
              points.insert(points.end(), x.begin(), x.end());
              const double away = (x[0] - 0.3) * (x[0] - 0.3) + (x[1] - 0.8) * (x[1] - 0.8);
              const double outside = x[0] + x[1] - 0.9;
              if (outside <= 0 && away < least) least = away, best = {x[0], x[1]};
              return Minimisation::Value{away, {outside}};
            }};
  }

  double least = 1e9;
  std::vector<double> best, points;
};

TEST_F(NearestPoint, IsFoundByGoingDown) {
  go_down(problem(), {0.9, 0.0}, 0.1, 1e-5);
  EXPECT_NEAR(best.at(0), 0.2, 1e-3);
  EXPECT_NEAR(best.at(1), 0.7, 1e-3);
  EXPECT_LT(points.size(), 2 * 200U);
}

TEST_F(NearestPoint, IsFoundRoughlyByLookingAround) {
  look_around(problem(), 2, 150);
  EXPECT_NEAR(best.at(0), 0.2, 0.05);
  EXPECT_NEAR(best.at(1), 0.7, 0.05);
}

TEST_F(NearestPoint, IsSoughtAtTheSamePointsEveryTime) {
  const auto sought = [&] {
    points.clear();
    look_around(problem(), 2, 50);
    go_down(problem(), {0.9, 0.0}, 0.1, 1e-4);
    return points;
  };
  EXPECT_EQ(sought(), sought());
}

TEST_F(NearestPoint, WhatIsThrownReachesWhoeverBeganIt) {
  int looked = 0;
  const Minimisation throwing{.constraints = 0, .at = [&](std::span<const double> x) -> Minimisation::Value {
                                if (++looked == 7) throw std::out_of_range("enough");
                                return {x[0], {}};
                              }};
  EXPECT_THROW(go_down(throwing, {0.5, 0.5}, 0.1, 1e-6), std::out_of_range);
  EXPECT_EQ(looked, 7) << "nothing is asked for after that";
  looked = 0;
  EXPECT_THROW(look_around(throwing, 2, 100), std::out_of_range);
}

}  // namespace
}  // namespace mixloop
