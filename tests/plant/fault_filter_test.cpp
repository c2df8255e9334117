// SPDX-License-Identifier: MIT
// What each kind of fault makes of a sequence, a value a tick.
#include <gtest/gtest.h>

#include <cmath>

#include "plant/faults.hpp"

namespace mixloop {
namespace {

using Kind = Fault::Kind;

constexpr double kFilterRate = 1000;
constexpr int kBegin = 10, kEnd = 60, kTicks = 100;

double value(int k) { return 3 + std::sin(0.2 * k); }

/// The sequence through a fault from kBegin to kEnd.
std::vector<double> through(Kind kind, double magnitude, std::uint64_t seed = 1, int asked = 1) {
  FaultFilter filter(Chance(seed), 0, Draw::motor_fault, kFilterRate);
  std::vector<double> out;
  for (int k = 0; k < kTicks; ++k) {
    if (k == kBegin) filter.start(kind, magnitude);
    if (k == kEnd) filter.start(Kind::none, 0);
    for (int i = 1; i < asked; ++i) filter.pass(k, -99);  // what isn't the tick's last doesn't count
    out.push_back(filter.pass(k, value(k)));
    EXPECT_EQ(filter.active(), kind != Kind::none && k >= kBegin && k < kEnd);
  }
  return out;
}

void expect_within(const std::vector<double>& out, const std::function<double(int)>& expected) {
  for (int k = 0; k < kTicks; ++k) EXPECT_EQ(out[k], k >= kBegin && k < kEnd ? expected(k) : value(k)) << k;
}

TEST(FaultFilter, LeavesTheSequenceWhereNothingIsWrong) { expect_within(through(Kind::none, 0), value); }

TEST(FaultFilter, OffGivesZero) {
  expect_within(through(Kind::off, 0), [](int) { return 0; });
}

TEST(FaultFilter, StuckKeepsTheLastValue) {
  expect_within(through(Kind::stuck, 0), [](int) { return value(kBegin - 1); });
}

TEST(FaultFilter, WrongIsOffByItsMagnitude) {
  expect_within(through(Kind::wrong, -0.5), [](int k) { return value(k) - 0.5; });
}

TEST(FaultFilter, DelayedKeepsTheLastValueAndThenGoesOnLate) {
  expect_within(through(Kind::delayed, 0.005),
                [](int k) { return k < kBegin + 5 ? value(kBegin - 1) : value(k - 5); });
  expect_within(through(Kind::delayed, 1), [](int) { return value(kBegin - 1); });
}

// Of a step of 1: 1 - e^(-t/T), t counted from the tick before it.
TEST(FaultFilter, SlowFollowsTheExponential) {
  constexpr double kT = 0.008;
  FaultFilter filter(Chance(1), 0, Draw::motor_fault, kFilterRate);
  filter.pass(0, 0);
  filter.start(Kind::slow, kT);
  for (int k = 1; k < 50; ++k)
    EXPECT_NEAR(filter.pass(k, 1), -std::expm1(-k / (kT * kFilterRate)), 1e-14) << k;
}

TEST(FaultFilter, GarbageIsAnythingUpToItsMagnitude) {
  const auto out = through(Kind::garbage, 2);
  double least = 0, most = 0;
  for (int k = kBegin; k < kEnd; ++k) {
    EXPECT_NE(out[k], out[k - 1]);
    least = std::min(least, out[k]), most = std::max(most, out[k]);
  }
  EXPECT_TRUE(least >= -2 && least < -1 && most < 2 &&
              most > 1);  // 50 draws miss a quarter once in 1e6 seeds
  EXPECT_EQ(out, through(Kind::garbage, 2)) << "the same seed";
  EXPECT_NE(out, through(Kind::garbage, 2, 2)) << "another seed";
}

TEST(FaultFilter, IntermittentIsOffForItsShareOfTime) {
  FaultFilter filter(Chance(1), 0, Draw::motor_fault, kFilterRate);
  filter.start(Kind::intermittent, 0.3);
  constexpr int kMany = 20'000;
  int off = 0;
  for (int k = 0; k < kMany; ++k) {
    const double out = filter.pass(k, value(k));
    EXPECT_TRUE(out == 0 || out == value(k));
    off += out == 0;
  }
  EXPECT_LT(std::abs(off - 0.3 * kMany), 4.4 * std::sqrt(0.3 * 0.7 * kMany));  // missed by one seed in 1e5
}

TEST(FaultFilter, TakesTheLastValueOfATick) {
  for (const Kind kind :
       {Kind::stuck, Kind::garbage, Kind::wrong, Kind::slow, Kind::delayed, Kind::intermittent})
    EXPECT_EQ(through(kind, 0.02), through(kind, 0.02, 1, 3)) << static_cast<int>(kind);
}

TEST(FaultFilter, FromTheFirstTickOnKeepsTheFirstValue) {
  for (const Kind kind : {Kind::stuck, Kind::delayed, Kind::slow}) {
    FaultFilter filter(Chance(1), 0, Draw::position_fault, kFilterRate);
    filter.start(kind, 0.01);
    EXPECT_EQ(filter.pass(0, 5), 5);
  }
}

}  // namespace
}  // namespace mixloop
