// SPDX-License-Identifier: MIT
// Gains that make a sum of squares least.
#include "stability/regulator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

// x+ = a x + b u: P = q + a^2 P r / (r + b^2 P), a quadratic; K = a b P / (r + b^2 P).
TEST(Regulator, OfOneNumberIsThatOfAQuadratic) {
  Held held(Matrix::Zero(1, 1), Matrix::Zero(1, 1), 1);
  for (const auto& [a, b, q, r] :
       {std::array{2.0, 1.0, 1.0, 1.0}, {0.5, 3.0, 2.0, 0.1}, {1.0, 0.01, 5.0, 7.0}}) {
    held.Phi(0, 0) = a, held.Gamma(0, 0) = b;
    const double half = (r - q * b * b - a * a * r) / 2;
    const double P = (-half + std::sqrt(half * half + b * b * q * r)) / (b * b);
    const auto gain = regulator_gain(held, Vector{{q}}, Vector{{r}});
    ASSERT_TRUE(gain);
    EXPECT_NEAR((*gain)(0, 0), a * b * P / (r + b * b * P), 1e-12);
  }
}

// The cart-pole of the Control Tutorials for MATLAB and Simulink, whose gain of lqr(A, B, diag(5000, 0, 100,
// 0), 1) is printed there: ticks of 10 us are as good as none.
TEST(Regulator, OfTheCartPoleComesToThePublishedOneAsTicksGetShort) {
  const double p = 0.0132;
  const Matrix A{{0, 0, 1, 0},
                 {0, 0, 0, 1},
                 {0, 0.04 * 9.8 * 0.09 / p, -0.0024 / p, 0},
                 {0, 0.2 * 9.8 * 0.3 * 0.7 / p, -0.006 / p, 0}};
  const Matrix B{{0}, {0}, {0.024 / p}, {0.06 / p}};
  const auto gain = regulator_gain({A, B, 1e-5}, Vector{{5000, 100, 0, 0}}, Vector{{1}});
  ASSERT_TRUE(gain);
  const double printed[] = {-70.7107, 105.5298, -37.8345, 20.9238};
  for (Eigen::Index j = 0; j < 4; ++j) EXPECT_NEAR((*gain)(0, j) / printed[j], 1, 1e-3) << *gain;
}

TEST(Regulator, MakesTheLoopStableThatItIsFor) {
  const Held held(Matrix{{0, 0, 1, 0}, {0, 0, 0, 1}, {0, 9, 0, 0}, {1, 20, 0, 0}}, Matrix{{0}, {0}, {1}, {2}},
                  0.01);
  const auto gain = regulator_gain(held, Vector{{1, 1, 0, 0}}, Vector{{0.1}});
  ASSERT_TRUE(gain);
  EXPECT_LT(eigenvalues(held.Phi - held.Gamma * *gain).cwiseAbs().maxCoeff(), 1);
}

TEST(Regulator, IsNoneWhereTheTorqueDoesNotReachWhatGrows) {
  const Held held(Matrix{{0, 1}, {1, 0}}, Matrix{{0}, {0}}, 0.1);
  EXPECT_FALSE(regulator_gain(held, Vector{{1, 1}}, Vector{{1}}));
}

}  // namespace
}  // namespace mixloop
