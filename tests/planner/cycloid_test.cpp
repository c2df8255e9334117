// SPDX-License-Identifier: MIT
#include "planner/cycloid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/oracles/wide.hpp"

namespace mixloop {
namespace {

using oracle::Wide;

TEST(Cycloid, IsAtRestAtBothEnds) {
  for (const double x : {0.0, 1.0, -3.0, 7.0}) {
    const auto [s, sd, sdd] = cycloid(x, 5, 2);
    EXPECT_EQ(s, x > 0.5 ? 5 : 0);
    EXPECT_EQ(sd, 0);
    EXPECT_EQ(sdd, 0);
  }
}

// By hand: halfway s = S/2, s' = 2 S/T; at a quarter s'' = 2 pi S/T^2 and s = S (1/4 - 1/(2 pi)).
TEST(Cycloid, HasTheValuesByHandAtHalfAndQuarter) {
  const auto half = cycloid(0.5, 3, 2);
  EXPECT_DOUBLE_EQ(half.s, 1.5);
  EXPECT_DOUBLE_EQ(half.sd, 3);
  EXPECT_NEAR(half.sdd, 0, 1e-15);
  const auto quarter = cycloid(0.25, 3, 2);
  EXPECT_DOUBLE_EQ(quarter.s, 3 * (0.25 - 1 / (2 * std::numbers::pi)));
  EXPECT_DOUBLE_EQ(quarter.sd, 1.5);
  EXPECT_DOUBLE_EQ(quarter.sdd, 1.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(cycloid(0.75, 3, 2).sdd, -1.5 * std::numbers::pi);
}

// Against (34) and its derivatives in 113 bits; a few roundings, relative to each value, down to x = 1e-100.
TEST(Cycloid, IsExactToRoundOff) {
  const Wide two_pi = 2 * acos(Wide(-1));
  const auto relative = [](double found, const Wide& expected) {
    return std::abs(static_cast<double>((found - expected) / expected));
  };
  for (int i = 1; i < 4000; ++i) {
    const double x = i < 2000 ? i / 2000.0 : std::pow(10.0, -(i - 1999) / 30.0);
    const auto [s, sd, sdd] = cycloid(x, 0.7, 3);
    // y - sin y loses the digits of y^2 / 6: all of them below 1e-17, where y^3 / 6 is exact.
    const Wide y = two_pi * x, cycle = x < 1e-8 ? y * y * y / 6 : Wide(y - sin(y));
    EXPECT_LT(relative(s, Wide(0.7) * cycle / two_pi), 5e-15) << x;
    EXPECT_LT(relative(sd, Wide(0.7) / 3 * 2 * sin(y / 2) * sin(y / 2)), 1e-15) << x;
    if (x == 0.5) continue;  // where sdd passes zero, its digits are those of x - 1/2
    EXPECT_LT(relative(sdd, Wide(0.7) / 9 * two_pi * sin(y)), 5e-15 / std::min(1.0, std::abs(x - 0.5))) << x;
  }
}

}  // namespace
}  // namespace mixloop
