// SPDX-License-Identifier: MIT
#include "runtime/clock/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace mixloop {
namespace {

using std::chrono::nanoseconds;

TEST(Histogram, OfNothingSaysZero) {
  const Histogram h;
  EXPECT_EQ(h.count(), 0U);
  EXPECT_EQ(h.quantile(0.5).count(), 0);
  EXPECT_EQ(h.max().count(), 0);
}

TEST(Histogram, CountsSmallDurationsExactly) {
  Histogram h;
  for (int i = 1; i <= 60; ++i) h.add(nanoseconds(i));
  EXPECT_EQ(h.quantile(0.5).count(), 30);
  EXPECT_EQ(h.quantile(1.0).count(), 60);
  EXPECT_EQ(h.quantile(0.0).count(), 1);
}

TEST(Histogram, TakesTheExtremesOfItsRange) {
  Histogram h;
  h.add(nanoseconds(-5));  // a clock that steps back counts as zero
  h.add(nanoseconds::max());
  EXPECT_EQ(h.count(), 2U);
  EXPECT_EQ(h.quantile(0.5).count(), 0);
  EXPECT_EQ(h.max(), nanoseconds::max());
}

TEST(Histogram, GivesQuantilesWithinItsStatedRelativeError) {
  std::mt19937_64 random(11);
  std::lognormal_distribution<double> distribution(11, 2);  // around 60 us, tails from us to s
  Histogram h;
  std::vector<std::int64_t> exact;
  for (int i = 0; i < 20000; ++i) {
    exact.push_back(static_cast<std::int64_t>(distribution(random)));
    h.add(nanoseconds(exact.back()));
  }
  std::sort(exact.begin(), exact.end());
  for (const double p : {0.001, 0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(exact.size()))) - 1;
    const double expected = static_cast<double>(exact[rank]);
    EXPECT_NEAR(static_cast<double>(h.quantile(p).count()), expected,
                Histogram::kRelativeError * expected + 1)
        << p;
  }
  EXPECT_EQ(h.max().count(), exact.back());
}

}  // namespace
}  // namespace mixloop
