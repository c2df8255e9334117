// SPDX-License-Identifier: MIT
#include "dynamics/program/sincos.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certification.hpp"

namespace mixloop::testing {
namespace {

double ulps(double actual, const Wide& exact) {
  int exponent = 0;
  std::frexp(static_cast<double>(exact), &exponent);
  return static_cast<double>(abs(Wide(actual) - exact)) / std::ldexp(1.0, exponent - 53);
}

// The figures that sincos.hpp states.
TEST(Sincos, StaysWithinItsStatedError) {
  std::mt19937_64 random(5);
  double near = 0.0, far = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double reach = std::pow(10.0, std::uniform_real_distribution<double>(-3.0, 6.0)(random));
    double x = std::uniform_real_distribution<double>(-reach, reach)(random);
    if (k % 8 == 0) x = std::nextafter(std::round(x) * 1.5707963267948966, x);  // beside the zeros
    double s = 0.0, c = 0.0;
    mixloop_sincos::sincos(x, &s, &c);
    const double error = std::max(ulps(s, sin(Wide(x))), ulps(c, cos(Wide(x))));
    double& worst = std::abs(x) <= 100.0 ? near : far;
    worst = std::max(worst, error);
  }
  EXPECT_LE(near, 1.6);
  EXPECT_LE(far, 2.5);
}

TEST(Sincos, SeveralAnglesAtOnceHaveTheBitsOfEachAlone) {
  std::mt19937_64 random(6);
  for (int k = 0; k < 20000; ++k) {
    const double reach = k % 5 == 0 ? 1e9 : 1e3;
    double x[3], sine[3], cosine[3];
    for (double& angle : x) angle = std::uniform_real_distribution<double>(-reach, reach)(random);
    mixloop_sincos::sincos_of(x, sine, cosine);
    for (int i = 0; i < 3; ++i) {
      double s = 0.0, c = 0.0;
      mixloop_sincos::sincos(x[i], &s, &c);
      ASSERT_EQ(s, sine[i]);
      ASSERT_EQ(c, cosine[i]);
    }
  }
}

TEST(Sincos, WhatIsNoNumberStaysNone) {
  for (double x : {NAN, INFINITY, -INFINITY}) {
    double s = 0.0, c = 0.0;
    mixloop_sincos::sincos(x, &s, &c);
    EXPECT_TRUE(std::isnan(s) && std::isnan(c));
  }
}

}  // namespace
}  // namespace mixloop::testing
