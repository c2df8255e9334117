// SPDX-License-Identifier: MIT
#include "report/envelope.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace mixloop {
namespace {

using testing::ElementsAre;

Envelope of(const std::vector<double>& values, std::size_t capacity) {
  Envelope envelope(capacity);
  for (const double value : values) envelope.add(value);
  return envelope;
}

TEST(Envelope, IsTheCurveItselfWhileItFits) {
  const Envelope envelope = of({3, 1, 4, 1}, 4);
  EXPECT_EQ(envelope.width(), 1);
  EXPECT_THAT(envelope.points(), ElementsAre(3, 1, 4, 1));
}

TEST(Envelope, HoldsLeastAndGreatestInTheOrderInWhichTheyCame) {
  const Envelope envelope = of({3, 1, 4, 1, 5, 9, 2, 6}, 2);
  EXPECT_EQ(envelope.width(), 4);
  EXPECT_THAT(envelope.points(), ElementsAre(1, 4, 9, 2));
}

TEST(Envelope, HasTheLastBucketOfWhatIsThere) {
  EXPECT_THAT(of({1, 2, 3, 4, 5}, 2).points(), ElementsAre(1, 4, 5, 5));
  EXPECT_THAT(of({1, 2, 3}, 2).points(), ElementsAre(1, 2, 3, 3));
}

TEST(Envelope, LosesNoPeakWhereverItStands) {
  std::mt19937 random(20);
  std::normal_distribution<double> noise;
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed 20, trial " << trial);
    std::vector<double> values(1 + random() % 700);
    for (double& value : values) value = std::round(noise(random) * 64);  // exact as floats, with ties
    const Envelope envelope = of(values, 16);
    const auto points = envelope.points();
    const auto width = static_cast<std::size_t>(envelope.width());
    if (width == 1) continue;
    ASSERT_EQ(points.size(), 2 * ((values.size() + width - 1) / width));
    ASSERT_LE(points.size(), 32u);
    for (std::size_t bucket = 0; 2 * bucket < points.size(); ++bucket) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(bucket * width);
      const auto last =
          values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), (bucket + 1) * width));
      const auto [least, greatest] = std::minmax_element(first, last);
      const auto [low, high] = std::minmax(points[2 * bucket], points[2 * bucket + 1]);
      EXPECT_EQ(low, *least);
      EXPECT_EQ(high, *greatest);
      if (*least == *greatest) continue;
      const bool greatest_first = std::find(first, last, *greatest) < std::find(first, last, *least);
      EXPECT_EQ(points[2 * bucket] == *greatest, greatest_first);
    }
  }
}

TEST(Envelope, LeavesGaps) {
  const auto points = of({NAN, NAN, 1, NAN}, 2).points();
  EXPECT_TRUE(std::isnan(points[0]) && std::isnan(points[1]));
  EXPECT_THAT(std::vector(points.begin() + 2, points.end()), ElementsAre(1, 1));
  EXPECT_TRUE(of({NAN, NAN}, 2).empty());
  EXPECT_FALSE(of({NAN, 0}, 2).empty());
}

TEST(Envelope, CoarsensToWhatASmallerOneHolds) {
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(0.7 * static_cast<double>(i));
  Envelope envelope = of(values, 32);
  envelope.coarsen();
  EXPECT_EQ(envelope.points(), of(values, 16).points());
  envelope.add(7);
  values.push_back(7);
  EXPECT_EQ(envelope.points(), of(values, 16).points());
}

}  // namespace
}  // namespace mixloop
