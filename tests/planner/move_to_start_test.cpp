// SPDX-License-Identifier: MIT
#include "planner/move_to_start.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

// By hand: from rest to rest it is 10 x^3 - 15 x^4 + 6 x^5, half the way at half the time, at 15/8 of the
// mean rate.
TEST(MoveToStart, FromRestToRestIsTheQuinticByHand) {
  const Vector from = Eigen::Vector2d(1, -2), to = Eigen::Vector2d(5, 2), zero = Vector::Zero(2);
  const MoveToStart move(from, {to, zero, zero}, 2);
  EXPECT_EQ(move.at(0).psi, from);
  EXPECT_EQ(move.at(0).psid, zero);
  EXPECT_EQ(move.at(0).psidd, zero);
  EXPECT_EQ(move.at(1).psi, to);
  EXPECT_EQ(move.at(1).psid, zero);
  EXPECT_EQ(move.at(1).psidd, zero);
  EXPECT_EQ(move.at(0.5).psi, Eigen::Vector2d(3, 0));
  EXPECT_EQ(move.at(0.5).psid, Eigen::Vector2d(3.75, 3.75));
  EXPECT_EQ(move.at(0.5).psidd, zero);
}

TEST(MoveToStart, EndsWithTheMotionThatItWasGiven) {
  const Vector from = Eigen::Vector2d(1, -2);
  const PsiMotion to{Eigen::Vector2d(2, 3), Eigen::Vector2d(4, -5), Eigen::Vector2d(-6, 7)};
  const MoveToStart move(from, to, 0.5);
  EXPECT_LT((move.at(1).psi - to.psi).norm(), 1e-14);
  EXPECT_LT((move.at(1).psid - to.psid).norm(), 1e-13);
  EXPECT_LT((move.at(1).psidd - to.psidd).norm(), 1e-12);
  // Rates are derivatives: central differences, error h^2 psi''''' / 6 and round-off / h.
  const double h = 1e-5;
  for (const double x : {0.1, 0.5, 0.8}) {
    const PsiMotion before = move.at(x - h), now = move.at(x), after = move.at(x + h);
    EXPECT_LT((now.psid - (after.psi - before.psi) / (2 * h * 0.5)).norm(), 1e-6);
    EXPECT_LT((now.psidd - (after.psid - before.psid) / (2 * h * 0.5)).norm(), 1e-5);
  }
}

TEST(ShortestMove, IsThatOfTheSlowestMotorAndASecondAtLeast) {
  EXPECT_DOUBLE_EQ(shortest_move(Eigen::Vector3d(8, -16, 100), Eigen::Vector3d(1, 1, 0)), 30);
  EXPECT_EQ(shortest_move(Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(1, 1, 1)), 1);
  EXPECT_EQ(shortest_move(Eigen::Vector3d(5, 5, 5), Eigen::Vector3d::Zero()), 1);
}

}  // namespace
}  // namespace mixloop
