// SPDX-License-Identifier: MIT
// Nothing of a plan hangs on the units: fine drives beside coarse ones, homes many turns away, mechanisms of
// micrometres and of hundreds of metres.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "planner/inverse_kinematics.hpp"
#include "planner/plan.hpp"
#include "planner/singularity.hpp"
#include "tests/planner/mechanisms.hpp"

namespace mixloop {
namespace {

/// A slide along x that a drive moves by so many metres a radian.
Model<double> slide_by(const std::string& drive) {
  return model_from(fmt::format(R"(
motors: [psi]
coordinates: [x]
constraints: {{x: {}}}
transforms: [{{from: 0, to: table, s: x}}]
bodies: [{{frame: table, mass: 1}}]
end_effector: {{frame: table, axes: [z]}}
)",
                                drive));
}

class Drive : public testing::TestWithParam<double> {};

TEST_P(Drive, IsFollowedHoweverFine) {
  const double metres = GetParam();
  const auto model = slide_by(fmt::format("{} m * psi", metres));
  const Plan plan(model, path_from("{line: {from: [1 mm], to: [2 mm]}, duration: 1 s}", model), {});
  EXPECT_NEAR(plan.at(0).psi[0] * metres, 1e-3, 1e-17);
  EXPECT_NEAR(plan.at(1000).psi[0] * metres, 2e-3, 1e-17);
}
INSTANTIATE_TEST_SUITE_P(MetresARadian, Drive, testing::Values(1e-15, 1e-9, 1e-6, 1.4e-6, 1e-3, 1.0, 1e6));

TEST(Drive, OfOneAxisMayBeFineBesideCoarseOnes) {
  const auto model = model_from(R"(
motors: {a: rotary, b: linear, c: rotary}
coordinates: [z, x, y]
constraints: {z: 1 m * a, x: b, y: 1e-9 m * c}
transforms:
  - {from: 0, to: 1, s: z, alpha: -90 deg, theta: -90 deg}
  - {from: 1, to: 2, s: x, alpha: -90 deg, theta: 90 deg}
  - {from: 2, to: 3, s: y}
bodies: [{frame: 3, mass: 2 kg}]
end_effector: {frame: 3}
)");
  InverseKinematics ik(model);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(3, -40, 500)}) {
    Vector psi;
    ASSERT_EQ(ik.position_from_home(point, 0, psi), IkOutcome::solved);
    EXPECT_LE(ik.miss(point, 0, psi), 1e-15 * point.norm());
  }
}

// A jib that two motors turn, one of them by 1e-7: the sine of a fine drive.
TEST(Drive, MayBeFineInAMixture) {
  const auto model = model_from(R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {qa: a, qb: 1e-7 * b}
transforms:
  - {from: 0, to: 1, theta: qa, a: 1 m}
  - {from: 1, to: 2, theta: qb, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, y]}
home: {b: 1e7}
)");
  InverseKinematics ik(model);
  Vector psi;
  ASSERT_EQ(ik.position_from_home({1, 1, 0}, 0, psi), IkOutcome::solved);
  EXPECT_NEAR(psi[1] * 1e-7, std::numbers::pi / 2, 1e-14);
}

TEST(Home, MayBeManyTurnsAway) {
  const auto model = model_from(R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {qa: a, qb: b}
transforms:
  - {from: 0, to: 1, theta: qa, a: 1 m}
  - {from: 1, to: 2, theta: qb, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, y]}
home: {a: 628318530.7, b: 628318532.0}
)");
  InverseKinematics ik(model);
  Vector psi;
  ASSERT_EQ(ik.position_from_home({1, 1, 0}, 0, psi), IkOutcome::solved);
  // A unit in the last place of the motors is 1.2e-7 rad.
  EXPECT_LE(ik.miss({1, 1, 0}, 0, psi), 4e-7);
  const Plan plan(model, path_from("{line: {from: [1, 1], to: [1.2, 0.8]}, duration: 0.1 s}", model), {});
  EXPECT_EQ(plan.ticks(), 100);
}

class Size : public testing::TestWithParam<double> {};

TEST_P(Size, OfAnArmIsNoMatter) {
  const double length = GetParam();
  const auto model = model_from(fmt::format(R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {{qa: a, qb: b}}
transforms:
  - {{from: 0, to: 1, theta: qa, a: {0} m}}
  - {{from: 1, to: 2, theta: qb, a: {0} m}}
bodies: [{{frame: 2, mass: 1 kg}}]
end_effector: {{frame: 2, axes: [x, y]}}
home: {{b: 90 deg}}
)",
                                            length));
  InverseKinematics ik(model);
  Vector psi;
  ASSERT_EQ(ik.position_from_home({length, length, 0}, 0, psi), IkOutcome::solved);
  EXPECT_NEAR(psi[1], std::numbers::pi / 2, 1e-14);
  EXPECT_EQ(ik.position_from_home({2.001 * length, 0, 0}, 0, psi), IkOutcome::out_of_reach);
  SingularityMeasures measures(model, ik.motor_scale(), std::vector<int>{});
  double value = 0;
  measures.evaluate(Eigen::Vector2d(0, std::numbers::pi / 2), 0, &value);
  EXPECT_NEAR(value, 1, 1e-14);
  EXPECT_TRUE(measures.on_home_branch(Eigen::Vector2d(0, 1), 0));
  EXPECT_FALSE(measures.on_home_branch(Eigen::Vector2d(0, -1), 0));
}
INSTANTIATE_TEST_SUITE_P(Metres, Size, testing::Values(1e-12, 1e-6, 1.0, 300.0, 1e7));

TEST(Slide, OfHundredsOfMetresIsFollowed) {
  const auto model = slide_by("10 mm * psi");
  const Plan plan(model, path_from("{line: {from: [0], to: [800 m]}, duration: 60 s}", model), {});
  EXPECT_NEAR(plan.at(60'000).psi[0], 80'000, 1e-10);
}

// A named measure has units of its own: small everywhere is not zero at home.
TEST(NamedSingularity, IsNotTakenForOneAtHomeBecauseItsUnitIsSmall) {
  const std::string scene = R"(
motors: [a, b]
coordinates: [qa, qb]
constraints: {qa: a, qb: b}
transforms:
  - {from: 0, to: 1, theta: qa, a: 1 m}
  - {from: 1, to: 2, theta: qb, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2, axes: [x, y]}
home: {b: 90 deg}
singularities: {area: 1e-18 m^2 * cos(qb - 30 deg)}
)";
  const auto model = model_from(scene);
  SingularityMeasures measures(model, Vector::Ones(2), std::vector<int>{});
  EXPECT_TRUE(measures.on_home_branch(Eigen::Vector2d(0, 1), 0));
  EXPECT_FALSE(measures.on_home_branch(Eigen::Vector2d(0, 2.5), 0)) << "past 120 deg its cosine is negative";
}

}  // namespace
}  // namespace mixloop
