// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop::testing {
namespace {

using oracle::Wide;

double ulps(double actual, const Wide& exact) {
  int exponent = 0;
  std::frexp(static_cast<double>(exact), &exponent);
  return static_cast<double>(abs(Wide(actual) - exact)) / std::ldexp(1.0, std::max(exponent, -1021) - 53);
}

class Functions : public ::testing::Test {
 protected:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  std::mt19937_64 random{5};
};

// The figures that the headers state.
TEST_F(Functions, SineAndCosineStayWithinTheirStatedError) {
  double worst = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double reach = std::pow(10.0, between(-3.0, 6.0));
    double x = between(-reach, reach);
    if (k % 8 == 0) x = std::nextafter(std::round(x) * 1.5707963267948966, x);  // beside the zeros
    double s = 0.0, c = 0.0;
    mixloop_functions::sincos(x, &s, &c);
    worst = std::max({worst, ulps(s, sin(Wide(x))), ulps(c, cos(Wide(x)))});
  }
  EXPECT_LE(worst, 1.6);
}

// By 1200 bits, of which 1024 say how many turns the largest make.
TEST_F(Functions, LargeAnglesAreNoWorse) {
  using namespace boost::multiprecision;
  using Long = number<cpp_bin_float<1200, digit_base_2>, et_off>;
  const auto error = [](double x) {
    double s = 0.0, c = 0.0;
    mixloop_functions::sincos(x, &s, &c);
    return std::max(ulps(s, Wide(sin(Long(x)))), ulps(c, Wide(cos(Long(x)))));
  };
  double worst = error(6381956970095103.0 * std::pow(2.0, 797));  // the nearest to a multiple of pi/2
  for (int k = 0; k < 500; ++k)
    worst = std::max(
        worst, error((k % 2 ? 1 : -1) * std::ldexp(between(1, 2), static_cast<int>(between(20, 1023.9)))));
  worst = std::max({worst, error(0x1p+20), error(-0x1p+20), error(std::numeric_limits<double>::max())});
  EXPECT_LE(worst, 1.6);
}

TEST_F(Functions, SeveralAnglesAtOnceHaveTheBitsOfEachAlone) {
  for (int k = 0; k < 20000; ++k) {
    const double reach = k % 5 == 0 ? 1e9 : k % 5 == 1 ? 3e6 : 1e3;
    double x[3], sine[3], cosine[3];
    for (double& angle : x) angle = between(-reach, reach);
    mixloop_functions::sincos_of(x, sine, cosine);
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(mixloop_functions::sin(x[i]), sine[i]);
      ASSERT_EQ(mixloop_functions::cos(x[i]), cosine[i]);
    }
  }
}

TEST_F(Functions, ExponentialLogarithmAndArcTangentStayWithinTheirStatedErrors) {
  double exponential = 0, tiny = 0, logarithm = 0, angle = 0;
  for (int k = 0; k < 30000; ++k) {
    const double x = k % 2 ? between(-745, 709.7) : between(-1, 1), power = mixloop_functions::exp(x);
    double& worst = power < 0x1p-1021 ? tiny : exponential;
    worst = std::max(worst, ulps(power, exp(Wide(x))));
    const double z = k % 3 == 0   ? std::ldexp(between(1, 2), static_cast<int>(between(-1070, 1023)))
                     : k % 3 == 1 ? between(0.5, 2)
                                  : 1 + between(-1, 1) * std::pow(10.0, between(-15, -1));
    logarithm = std::max(logarithm, ulps(mixloop_functions::log(z), log(Wide(z))));
    const double reach = k % 2 ? std::pow(10.0, between(-5, 5)) : 1;
    const double v = between(-reach, reach), u = between(-1, 1);
    angle = std::max(angle, ulps(mixloop_functions::atan2(v, u), atan2(Wide(v), Wide(u))));
  }
  EXPECT_LE(exponential, 0.9);
  EXPECT_LE(tiny, 1.4);
  EXPECT_LE(logarithm, 0.7);
  EXPECT_LE(angle, 1.0);
}

TEST_F(Functions, EndsAndSignsAreThoseOfTheCLibrary) {
  const double inf = HUGE_VAL, least = std::numeric_limits<double>::denorm_min();
  const auto same = [](double ours, double theirs) {
    return std::isnan(theirs) ? std::isnan(ours)
                              : std::bit_cast<std::uint64_t>(ours) == std::bit_cast<std::uint64_t>(theirs);
  };
  for (double x : {0.0, -0.0, 1e4, -1e4, inf, -inf, double(NAN)})
    EXPECT_TRUE(same(mixloop_functions::exp(x), std::exp(x))) << x;
  for (double x : {0.0, -0.0, 1.0, -1.0, inf, -inf, double(NAN)})
    EXPECT_TRUE(same(mixloop_functions::log(x), std::log(x))) << x;
  for (double x : {inf, -inf, double(NAN)}) {
    EXPECT_TRUE(std::isnan(mixloop_functions::sin(x)));
    EXPECT_TRUE(std::isnan(mixloop_functions::cos(x)));
  }
  for (double y : {0.0, -0.0, 1.0, -1.0, least, -least, 1e308, inf, -inf, double(NAN)})
    for (double x : {0.0, -0.0, 1.0, -1.0, least, -least, 1e308, -1e308, inf, -inf, double(NAN)})
      EXPECT_TRUE(same(mixloop_functions::atan2(y, x), std::atan2(y, x))) << y << " " << x;
}

// On every processor, by every compiler.
TEST_F(Functions, HaveTheBitsThatTheyAlwaysHad) {
  std::uint64_t hash = 14695981039346656037u, seed = 1;
  const auto unit = [&] {  // no library's distribution
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(seed >> 11) * 0x1p-53;
  };
  for (int k = 0; k < 1000; ++k) {
    const double scale = k % 3 == 0 ? 1.0 : k % 3 == 1 ? 1e3 : 1e12, x = (unit() - 0.5) * scale, y = unit();
    for (double z : {mixloop_functions::sin(x), mixloop_functions::cos(x),
                     mixloop_functions::exp(700 * (unit() - 0.5)), mixloop_functions::log(y * scale),
                     mixloop_functions::atan2(y, x), mixloop_functions::fma(x, y, -x)})
      hash = (hash ^ std::bit_cast<std::uint64_t>(z)) * 1099511628211u;
  }
  EXPECT_EQ(hash, 15164104819678284008u);
}

}  // namespace
}  // namespace mixloop::testing
