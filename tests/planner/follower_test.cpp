// SPDX-License-Identifier: MIT
#include "planner/follower.hpp"

#include <gtest/gtest.h>

#include "tests/planner/mechanisms.hpp"

namespace mixloop {
namespace {

// Newton's method from one tick's solution to the next, beside the closed form: round-off times the
// condition.
TEST(Follower, GoesTheSameWayByBothMethods) {
  const auto model = paper_robot();
  InverseKinematics closed(model), general(model, InverseKinematics::Method::newton);
  const Itinerary itinerary(path_from(kPaperPath, model), 1000, 1);
  Follower left(closed, itinerary, 0), right(general, itinerary, 0);
  ASSERT_EQ(left.start({}), IkOutcome::solved);
  ASSERT_EQ(right.start({}), IkOutcome::solved);
  for (int k = 0; k <= 1000; ++k) {
    ASSERT_EQ(left.advance(k), IkOutcome::solved);
    ASSERT_EQ(right.advance(k), IkOutcome::solved);
    EXPECT_LT((left.now().motors.psi - right.now().motors.psi).norm(), 1e-11) << k;
    EXPECT_LT((left.now().motors.psid - right.now().motors.psid).norm(),
              1e-11 * (1 + left.now().motors.psid.norm()))
        << k;
    EXPECT_LT((left.now().motors.psidd - right.now().motors.psidd).norm(),
              1e-11 * (1 + left.now().motors.psidd.norm()))
        << k;
  }
}

// Two steps for the whole line: Newton's method goes there in smaller ones.
TEST(Follower, TakesCoarseGridsInSmallerSteps) {
  const auto model = paper_robot();
  InverseKinematics closed(model), general(model, InverseKinematics::Method::newton);
  const Itinerary itinerary(path_from(kPaperPath, model), 2, 1);
  Follower left(closed, itinerary, 0), right(general, itinerary, 0);
  ASSERT_EQ(left.start({}), IkOutcome::solved);
  ASSERT_EQ(right.start({}), IkOutcome::solved);
  for (int k = 1; k <= 2; ++k) {
    ASSERT_EQ(left.advance(k), IkOutcome::solved);
    ASSERT_EQ(right.advance(k), IkOutcome::solved);
    EXPECT_LT((left.now().motors.psi - right.now().motors.psi).norm(), 1e-11) << k;
  }
}

// The line from (1, 0) to (3, 0) leaves a reach of 2 m where s = 1/2.
TEST(Follower, FindsWhereTheWayEnds) {
  const auto model = model_from(kPlanarArm);
  InverseKinematics ik(model);
  const Itinerary itinerary(path_from("{line: {from: [1, 0], to: [3, 0]}, duration: 1 s}", model), 1000, 1);
  Follower follower(ik, itinerary, 0);
  ASSERT_EQ(follower.start({}), IkOutcome::solved);
  int k = 0;
  while (follower.advance(k) == IkOutcome::solved) ++k;
  EXPECT_NEAR(k, 500, 1);
  EXPECT_NEAR(follower.limit(k), 500, 0.01);
}

}  // namespace
}  // namespace mixloop
