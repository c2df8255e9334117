// SPDX-License-Identifier: MIT
// A plan for a mechanism of which not all coordinates have a motor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/plan.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

Model<double> model() { return make_model<double>(crane(), std::span<const double>()); }

Path path() {
  return read_path(parse_document("{line: {from: [0], to: [1]}, duration: 1 s}", "path.yaml"), *crane());
}

TEST(PlanOfACrane, PrescribesTheMotorsAlone) {
  const Plan plan(model(), path(), {.rate_hz = 100});
  EXPECT_EQ(plan.n_u(), 1);
  EXPECT_EQ(plan.at(0).psi.size(), 1);
  EXPECT_NEAR(plan.at(100).psi[0], 1, 1e-12);
  EXPECT_NEAR(plan.at(50).psid[0], 2, 1e-12) << "the cycloid's peak, twice the mean";
  EXPECT_NEAR(plan.at(50).position[2], 0.5, 1e-12);
}

// With the load held below it the trolley moves 3 kg; the cycloid accelerates by 2 pi m/s^2 at most.
TEST(PlanOfACrane, AsksForTheForceThatHoldsTheLoadBelow) {
  const auto force = [](double limit) {
    return Plan(model(), path(), {.rate_hz = 100, .limits = {.torque = {limit}}});
  };
  EXPECT_NO_THROW(force(18.9));
  const auto error = input_error([&] { force(18.8); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->message, HasSubstr("the motor trolley would need 18.849"));
}

TEST(PlanOfACrane, StartsWhereItsMotorsStand) {
  const Plan plan(model(), path(), {.rate_hz = 100, .start_psi = {-0.5}});
  EXPECT_NEAR(plan.at(0).psi[0], -0.5, 1e-12);
  EXPECT_GT(plan.start_tick(), 0);
}

TEST(PlanOfACrane, RefusesListsOfAnotherLengthThanItsMotors) {
  for (const Plan::Settings& settings :
       {Plan::Settings{.limits = {.velocity = {1, 1}}}, Plan::Settings{.limits = {.torque = {1, 1}}},
        Plan::Settings{.start_psi = {0, 0}}}) {
    const auto error = input_error([&] { Plan(model(), path(), settings); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, "wrong_size");
    EXPECT_THAT(error->message, HasSubstr("one for each of the 1 motors"));
  }
}

TEST(WithFreeAtHome, LeavesTheFreeCoordinatesAtRest) {
  Scene scene = *crane();
  scene.home = {3, 0.5};
  const PsiMotion all = with_free_at_home(scene, {Vector{{1.0}}, Vector{{2.0}}, {}});
  EXPECT_EQ(all.psi, (Vector{{1.0, 0.5}}));
  EXPECT_EQ(all.psid, (Vector{{2.0, 0.0}}));
  EXPECT_EQ(all.psidd, (Vector{{0.0, 0.0}}));
}

}  // namespace
}  // namespace mixloop
