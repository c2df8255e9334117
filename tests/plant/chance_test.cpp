// SPDX-License-Identifier: MIT
#include "plant/chance.hpp"

#include <gtest/gtest.h>

#include <set>

namespace mixloop {
namespace {

// A statistic of N independent draws stays within 4.4 of its standard deviations but for once in 1e5 seeds;
// the seeds are fixed, so that these tests either hold or don't.
constexpr double kSigmas = 4.4;
constexpr int kDraws = 40'000;
const double kRoot = std::sqrt(double{kDraws});

TEST(Chance, DrawsUniformNumbersWithTheMomentsOfSuch) {
  const Chance chance(1);
  double sum = 0, squares = 0, neighbours = 0, before = 0;
  for (int k = 0; k < kDraws; ++k) {
    const double u = chance.uniform(k, 0, Draw::drop) - 0.5;
    ASSERT_TRUE(u >= -0.5 && u < 0.5);
    sum += u, squares += u * u, neighbours += u * before;
    before = u;
  }
  EXPECT_LT(std::abs(sum / kDraws), kSigmas * std::sqrt(1 / 12.0) / kRoot);
  EXPECT_LT(std::abs(squares / kDraws - 1 / 12.0),
            kSigmas * std::sqrt(1 / 180.0) / kRoot);  // var u^2 = 1/80 - 1/144
  EXPECT_LT(std::abs(neighbours / kDraws), kSigmas / 12 / kRoot);
}

TEST(Chance, DrawsNormalNumbersWithTheMomentsOfSuch) {
  const Chance chance(2);
  double sum = 0, squares = 0, fourths = 0, neighbours = 0, channels = 0, before = 0;
  int within = 0;
  for (int k = 0; k < kDraws; ++k) {
    const double z = chance.normal(k, 0, Draw::noise);
    sum += z, squares += z * z, fourths += z * z * z * z, neighbours += z * before;
    channels += z * chance.normal(k, 1, Draw::noise);
    within += std::abs(z) < 1;
    before = z;
  }
  EXPECT_LT(std::abs(sum / kDraws), kSigmas / kRoot);
  EXPECT_LT(std::abs(squares / kDraws - 1), kSigmas * std::sqrt(2.0) / kRoot);   // var z^2 = 2
  EXPECT_LT(std::abs(fourths / kDraws - 3), kSigmas * std::sqrt(96.0) / kRoot);  // var z^4 = 105 - 9
  EXPECT_LT(std::abs(neighbours / kDraws), kSigmas / kRoot);
  EXPECT_LT(std::abs(channels / kDraws), kSigmas / kRoot);
  const double p = std::erf(std::sqrt(0.5));
  EXPECT_LT(std::abs(static_cast<double>(within) / kDraws - p), kSigmas * std::sqrt(p * (1 - p)) / kRoot);
}

TEST(Chance, IsAFunctionOfItsArguments) {
  std::set<double> seen;
  int draws = 0;
  for (const std::uint64_t seed : {0, 1, 2})
    for (const std::int64_t tick : {0, 1, 1000})
      for (const std::size_t channel : {0, 1})
        for (const Draw draw :
             {Draw::noise, Draw::drop, Draw::motor_fault, Draw::position_fault, Draw::velocity_fault}) {
          seen.insert(Chance(seed).uniform(tick, channel, draw));
          EXPECT_EQ(Chance(seed).uniform(tick, channel, draw), Chance(seed).uniform(tick, channel, draw));
          ++draws;
        }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(draws));
}

}  // namespace
}  // namespace mixloop
