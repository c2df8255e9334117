// SPDX-License-Identifier: MIT
// What runs draw: normal quantiles, Sobol's points, strata, permutations.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <set>

#include "sweep/design.hpp"
#include "sweep/normal_quantile.hpp"

namespace mixloop {
namespace {

TEST(NormalQuantile, IsTheInverseOfTheErrorFunction) {
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 2e-15);  // tables
  EXPECT_NEAR(normal_quantile(1e-20), -9.262340089798409, 1e-14);
  for (double p = 1e-12; p < 0.5; p *= 1.3) {
    const double x = normal_quantile(p);
    // erfc is good to an ulp or two; an error of x shows as |x| times as much of p.
    EXPECT_NEAR(0.5 * std::erfc(-x / std::numbers::sqrt2) / p, 1, 1e-14 * (1 + x * x)) << p;
    EXPECT_NEAR(normal_quantile(1 - p), -x, 1e-15 / p) << p;
  }
}

// A (t, m, s)-net in two dimensions has t = 0: each box of 2^-a by 2^-b has one of 2^(a + b) points.
TEST(Sobol, EachElementaryBoxHasOnePoint) {
  for (const std::uint64_t seed : {1, 2}) {
    const Sobol sobol(2, Chance(seed));
    for (int a = 0; a <= 8; ++a) {
      std::set<std::pair<int, int>> boxes;
      for (int i = 0; i < 256; ++i)
        boxes.insert({static_cast<int>(std::ldexp(sobol.at(i, 0), a)),
                      static_cast<int>(std::ldexp(sobol.at(i, 1), 8 - a))});
      EXPECT_EQ(boxes.size(), 256U) << a;
    }
  }
}

TEST(Sobol, EveryDimensionIsEvenToTheLast) {
  const Sobol sobol(Sobol::kMostDimensions, Chance(1));
  for (const std::size_t dimension : {0U, 2U, 7U, 40U, 999U}) {
    std::set<int> strata;
    for (int i = 0; i < 1024; ++i) strata.insert(static_cast<int>(1024 * sobol.at(i, dimension)));
    EXPECT_EQ(strata.size(), 1024U) << dimension;
  }
}

TEST(Permutation, EachValueComesOnce) {
  for (std::int64_t size = 1; size < 70; ++size) {
    std::set<std::int64_t> values;
    for (std::int64_t i = 0; i < size; ++i) values.insert(Permutation(size, Chance(3), 5).at(i));
    EXPECT_EQ(values.size(), static_cast<std::size_t>(size));
    EXPECT_EQ(*values.begin(), 0);
    EXPECT_EQ(*values.rbegin(), size - 1);
  }
}

Design drawn(Spread spread, std::int64_t draws, std::uint64_t seed) {
  return Design({.varied = {parse_varied("a=1,2")},
                 .sampled = {parse_sampled("b=uniform(0, 10 kg)"), parse_sampled("c=normal(1, 2)")},
                 .draws = draws,
                 .spread = spread,
                 .seed = seed});
}

TEST(Draws, AHypercubeHasOneInEachStratum) {
  const Design design = drawn(Spread::latin, 50, 7);
  ASSERT_EQ(design.runs(), 100);
  for (const std::size_t entry : {1U, 2U}) {
    std::set<int> strata;
    for (std::int64_t run = 0; run < 50; ++run) {
      const double value = design.values(run)[entry].number;
      const double share = entry == 1 ? value / 10 : 0.5 * std::erfc(-(value - 1) / 2 / std::numbers::sqrt2);
      strata.insert(static_cast<int>(50 * share));
      EXPECT_EQ(design.values(50 + run)[entry].number, value) << "the same at each combination";
    }
    EXPECT_EQ(strata.size(), 50U);
  }
}

TEST(Draws, MomentsAreThoseAskedFor) {
  for (const Spread spread : {Spread::latin, Spread::sobol, Spread::random}) {
    const Design design = drawn(spread, 4096, 1);
    double sum = 0, squares = 0, uniform = 0, products = 0;
    for (std::int64_t run = 0; run < 4096; ++run) {
      const auto values = design.values(run);
      const double z = (values[2].number - 1) / 2, u = values[1].number - 5;
      sum += z, squares += z * z, uniform += u, products += z * u;
    }
    // Five standard errors of independent draws; the even ones are far within.
    const double error = 5 / std::sqrt(4096.0);
    EXPECT_NEAR(sum / 4096, 0, error);
    EXPECT_NEAR(squares / 4096, 1, error * std::numbers::sqrt2);
    EXPECT_NEAR(uniform / 4096, 0, error * 10 / std::sqrt(12));
    EXPECT_NEAR(products / 4096, 0, error * 10 / std::sqrt(12));
  }
}

TEST(Draws, AreAFunctionOfSeedAndRun) {
  for (const Spread spread : {Spread::latin, Spread::sobol, Spread::random}) {
    EXPECT_EQ(drawn(spread, 100, 1).values(17)[2].text, drawn(spread, 100, 1).values(17)[2].text);
    EXPECT_NE(drawn(spread, 100, 1).values(17)[2].text, drawn(spread, 100, 2).values(17)[2].text);
    EXPECT_NE(drawn(spread, 100, 1).values(17)[2].text, drawn(spread, 100, 1).values(18)[2].text);
  }
}

}  // namespace
}  // namespace mixloop
