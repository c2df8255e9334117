// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "integrators/dormand_prince.hpp"
#include "tests/integrators/known_motion.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop {
namespace {

using oracle::Wide;

/// The method after one step of the known motion from t on.
DormandPrince<Wide> stepped(const Vec<Wide>& from, const Wide& t, const Wide& h) {
  DormandPrince<Wide> method(3, 7);
  const auto rate = [&](int, const Wide& c, const Vec<Wide>& at, Vec<Wide>& dx) {
    KnownMotion<Wide>::rate(t + c * h, at, dx);
  };
  method.first_stage(from, rate);
  method.try_step(from, h, rate);
  method.last_stage(rate);
  return method;
}

/// The largest error inside one step of h from t = 0.5.
double error_inside(double step) {
  const Wide t(0.5), h(step);
  const Vec<Wide> from = KnownMotion<Wide>::at(t);
  const DormandPrince<Wide> method = stepped(from, t, h);
  Vec<Wide> x(7);
  double largest = 0;
  for (int i = 1; i < 8; ++i) {
    const Wide theta = Wide(i) / 8;
    dense_output(from, method.next(), h, method.slopes(), theta, x);
    const Vec<Wide> error = x - KnownMotion<Wide>::at(t + theta * h);
    largest = std::max(largest, static_cast<double>(error.cwiseAbs().maxCoeff()));
  }
  return largest;
}

TEST(DenseOutput, OfDormandAndPrinceIsOfOrderFour) {
  // Order 4: the error inside a step falls with the fifth power of the step.
  EXPECT_NEAR(std::log2(error_inside(1.0 / 128) / error_inside(1.0 / 256)), 5, 0.1);
  EXPECT_NEAR(std::log2(error_inside(1.0 / 512) / error_inside(1.0 / 1024)), 5, 0.05);
}

TEST(DenseOutput, MeetsTheStepsEnds) {
  const Wide t(0.5), h(0.125);
  const Vec<Wide> from = KnownMotion<Wide>::at(t);
  const DormandPrince<Wide> method = stepped(from, t, h);
  Vec<Wide> x(7);
  dense_output(from, method.next(), h, method.slopes(), Wide(0), x);
  EXPECT_TRUE(x == from);
  dense_output(from, method.next(), h, method.slopes(), Wide(1), x);
  EXPECT_LT(static_cast<double>((x - method.next()).cwiseAbs().maxCoeff()), 1e-32);
}

}  // namespace
}  // namespace mixloop
