// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "integrators/integrator.hpp"
#include "tests/integrators/known_motion.hpp"

namespace mixloop {
namespace {

template <class Method>
class ErrorControl : public testing::Test {};
using Pairs = testing::Types<DormandPrince<double>, Dop853<double>>;
TYPED_TEST_SUITE(ErrorControl, Pairs);

StepCount controlled(auto& method, Vector& x, double length, double tolerance, int most = 10000) {
  return controlled_steps(method, x, 3, length, tolerance, most, [](double t, const Vector& at, Vector& dx) {
    KnownMotion<double>::rate(t, at, dx);
  });
}

TYPED_TEST(ErrorControl, KeepsTheToleranceAndPaysMoreForMore) {
  int before = 0;
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    TypeParam method(3, 7);
    Vector x = KnownMotion<double>::at(0);
    const StepCount count = controlled(method, x, 1.0, tolerance);
    ASSERT_TRUE(count.finished);
    // tan doubles an early error by t = 1 a few times: the steps' errors add up to some tens of tolerances.
    EXPECT_LT(error_size<double>(x - KnownMotion<double>::at(1), x, 3), 100 * tolerance);
    EXPECT_GT(count.accepted, before);
    before = count.accepted;
  }
}

TYPED_TEST(ErrorControl, GivesUpOnWhatHasNoEnd) {
  TypeParam method(3, 7);
  Vector x = KnownMotion<double>::at(0);
  EXPECT_FALSE(controlled(method, x, 2.0, 1e-8).finished);  // tan ends at pi / 2
  x.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(controlled(method, x, 1.0, 1e-8).finished);
}

TEST(Integrator, MakesAPieceThatNeverEndsNotANumber) {
  Integrator integrator({Method::dormand_prince, 1, 1e-8}, 3, 7);
  Vector x = KnownMotion<double>::at(0);
  integrator.advance(
      x, 2.0, [](int, int, double t, const Vector& at, Vector& dx) { KnownMotion<double>::rate(t, at, dx); },
      [](double, const Vector&, auto&) {});
  EXPECT_TRUE(x.array().isNaN().all());
}

}  // namespace
}  // namespace mixloop
