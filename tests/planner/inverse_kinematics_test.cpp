// SPDX-License-Identifier: MIT
#include "planner/inverse_kinematics.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "planner/itinerary.hpp"
#include "tests/oracles/wide.hpp"
#include "tests/planner/mechanisms.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using Eigen::Vector3d;
using oracle::Wide;
using Method = InverseKinematics::Method;

constexpr double kPi = std::numbers::pi;

/// An arm of the family with everything that it may have: offsets of base and plane, a point beside the last
/// link's axis, motors in a mixture. `side` is the base's alpha, `home` the elbow's angle at home.
std::string crooked_arm(int side, int home) {
  return fmt::format(R"(
motors: [a, b, c]
coordinates: [q1, q2, q3]
constraints: {{q1: a/4 + 0.1, q2: q1/8 + b/10 - 0.2, q3: 2*q2 - c/5 + b/7}}
transforms:
  - {{from: 0, to: 1, theta: 30 deg - q1, s: 0.4, a: 0.1, alpha: {} deg}}
  - {{from: 1, to: 2, theta: q2, s: 0.05, a: 0.5}}
  - {{from: 2, to: 3, theta: q3 + 20 deg, s: -0.15, a: 0.3, alpha: 35 deg}}
bodies: [{{frame: 3, mass: 1}}]
end_effector: {{frame: 3, point: [0.05, 0.1, -0.07]}}
home: {{c: {} deg}}
)",
                     side, home);
}

// By hand: shoulder at the origin, links of 1 m, motors at the joints.
TEST(InverseKinematics, GivesWholeAnswersForWholeArms) {
  const auto model = model_from(R"(
motors: [a, b, c]
coordinates: [q1, q2, q3]
constraints: {q1: a, q2: b, q3: c}
transforms:
  - {from: 0, to: 1, theta: q1, alpha: 90 deg}
  - {from: 1, to: 2, theta: q2, a: 1}
  - {from: 2, to: 3, theta: q3, a: 1}
bodies: [{frame: 3, mass: 1}]
end_effector: {frame: 3}
home: {c: 1}
)");
  InverseKinematics ik(model);
  ASSERT_TRUE(ik.arm());
  Vector psi;
  ASSERT_EQ(ik.position_from_home({1, 0, 1}, 0, psi), IkOutcome::solved);
  EXPECT_LT((psi - Vector3d(0, 0, kPi / 2)).norm(), 1e-15);
  ASSERT_EQ(ik.position_from_home({0, 1, -1}, 0, psi), IkOutcome::solved);
  EXPECT_LT((psi - Vector3d(kPi / 2, -kPi / 2, kPi / 2)).norm(), 1e-15);
  EXPECT_EQ(ik.position_from_home({2, 0, 1}, 0, psi), IkOutcome::out_of_reach);

  // The shoulder alone turns (1, 0, 1) about the origin.
  ik.position_from_home({1, 0, 1}, 0, psi);
  Vector psid, psidd;
  ASSERT_EQ(ik.rates({.position = {1, 0, 1}, .velocity = {-1, 0, 1}}, 0, psi, psid, psidd),
            IkOutcome::solved);
  EXPECT_LT((psid - Vector3d(0, 1, 0)).norm(), 1e-15);
}

TEST(InverseKinematics, KnowsTheFamilyByItsForm) {
  EXPECT_TRUE(InverseKinematics(paper_robot()).arm());
  EXPECT_TRUE(InverseKinematics(model_from(crooked_arm(90, -200))).arm());
  EXPECT_FALSE(InverseKinematics(model_from(kPlanarArm)).arm());
  EXPECT_FALSE(InverseKinematics(model_from(gantry(false))).arm());
  // A constraint that is not affine, and one that depends on time.
  EXPECT_FALSE(InverseKinematics(paper_robot({{"constraints.q1", "sin(psi1)/r1"}})).arm());
  EXPECT_FALSE(InverseKinematics(paper_robot({{"constraints.q1", "psi1/r1 + 0.1*t/(1 s)"}})).arm());
  // Motors that cannot move the three angles independently.
  EXPECT_FALSE(InverseKinematics(paper_robot({{"constraints.q3", "q2/2"}})).arm());
}

// However its chain is told.
TEST(InverseKinematics, KnowsTheFamilyByPosesToo) {
  const auto posed = [](const std::string& wrist) {
    return paper_robot({{"transforms",
                         "[{from: 0, to: 1, at: [0, 0, L1], rpy: [90 deg, 0, 0], revolute: q1, axis: y},"
                         "{from: 1, to: shoulder, revolute: q2}, {from: shoulder, to: 2, at: [L2, 0, 0]},"
                         "{from: 2, to: elbow, revolute: q5}, {from: elbow, to: 3, at: [L3, 0, 0], " +
                             wrist +
                             "}, {from: 1, to: 4, theta: q3, a: L4}, {from: 4, to: 5, theta: q6, a: L5},"
                             "{from: 5, to: 6, theta: q4, a: L6}]"}});
  };
  const Model<double> shipped_model = paper_robot(), posed_model = posed("rpy: [90 deg, 0, 0]");
  InverseKinematics shipped(shipped_model), poses(posed_model);
  ASSERT_TRUE(poses.arm());
  const Vector psi = Vector3d(0.3, -16, 17);
  const Eigen::Vector3d place = shipped.forward(psi, Vector::Zero(3), Vector::Zero(3), 0).position;
  Vector one = psi, other = psi;
  ASSERT_EQ(shipped.position(place, 0, one), IkOutcome::solved);
  ASSERT_EQ(poses.position(place, 0, other), IkOutcome::solved);
  EXPECT_LT((one - other).norm(), 1e-13);  // angles of tens of radians
  EXPECT_FALSE(InverseKinematics(posed("rpy: [90 deg, 0, 10 deg]")).arm()) << "four transforms";
}

TEST(InverseKinematics, TakesItsBranchFromHome) {
  EXPECT_EQ(InverseKinematics(paper_robot()).arm()->elbow, 1);
  EXPECT_EQ(InverseKinematics(paper_robot()).arm()->front, 1);
  EXPECT_EQ(InverseKinematics(paper_robot_elbow_down()).arm()->elbow, -1);
}

TEST(InverseKinematics, IsRefusedWithoutAsManyMotorsAsAxes) {
  const auto model = paper_robot({{"end_effector.axes", "[x, z]"}});
  const auto error = input_error([&] { InverseKinematics ik(model); });
  EXPECT_EQ(error->code, "no_inverse");
}

/// Random angles of the arm's axes on home's branch, away from its borders by a few degrees.
Vector random_pose(const ThreeAxisArm& arm, std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(-kPi, kPi), bent(0.1, kPi - 0.1);
  for (;;) {
    const Vector3d angles(angle(random), angle(random), arm.elbow * bent(random));
    const double radial =
        arm.base + arm.upper * std::cos(angles[1]) + arm.fore * std::cos(angles[1] + angles[2]);
    if (arm.front * radial > 0.05) return arm.motors(angles);
  }
}

class Family : public testing::TestWithParam<int> {
 protected:
  static Model<double> model() {
    switch (GetParam()) {
      case 0:
        return paper_robot();
      case 1:
        return paper_robot_elbow_down();
      case 2:
        return model_from(crooked_arm(90, -200));
      case 3:
        return model_from(crooked_arm(-90, 300));
      default:
        return model_from(crooked_arm(-90, -900));
    }
  }
};
INSTANTIATE_TEST_SUITE_P(InverseKinematics, Family, testing::Range(0, 5));

// Rounding of angles of a few turns, over arms of a metre.
TEST_P(Family, FindsThePointThatForwardKinematicsGave) {
  const auto arm_model = model();
  InverseKinematics ik(arm_model);
  ASSERT_TRUE(ik.arm());
  std::mt19937_64 random(11);
  const Vector zero = Vector::Zero(3);
  for (int sample = 0; sample < 1000; ++sample) {
    const Vector pose = random_pose(*ik.arm(), random);
    const Vector3d point = ik.forward(pose, zero, zero, 0).position;
    Vector psi;
    ASSERT_EQ(ik.position_from_home(point, 0, psi), IkOutcome::solved) << sample;
    EXPECT_LT(ik.miss(point, 0, psi), 1e-14) << sample;
    // The same pose, up to whole turns of the axes: near the borders angles are worse known than points.
    const Vector3d turns = (ik.arm()->angles(psi) - ik.arm()->angles(pose)) / (2 * kPi);
    EXPECT_LT((turns - turns.array().round().matrix()).norm(), 1e-12) << sample;
    const Vector3d from_home =
        ik.arm()->angles(psi) - ik.arm()->angles(Eigen::Map<const Vector>(arm_model.scene->home.data(), 3));
    EXPECT_LE(from_home.cwiseAbs().maxCoeff(), kPi * (1 + 1e-12));
    Vector again = pose;  // as a continuation it comes back as it was
    ASSERT_EQ(ik.position(point, 0, again), IkOutcome::solved);
    EXPECT_LT((again - pose).cwiseQuotient(ik.motor_scale()).norm(), 1e-12);
  }
}

TEST_P(Family, AgreesWithTheGeneralMethodInPositionAndRates) {
  const auto arm_model = model();
  InverseKinematics closed(arm_model), general(arm_model, Method::newton);
  EXPECT_FALSE(general.arm());
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> rate(-1, 1), nudge(-0.05, 0.05);
  const Vector zero = Vector::Zero(3);
  for (int sample = 0; sample < 300; ++sample) {
    const Vector pose = random_pose(*closed.arm(), random);
    const PathPoint point{.position = closed.forward(pose, zero, zero, 0).position,
                          .velocity = {rate(random), rate(random), rate(random)},
                          .acceleration = {rate(random), rate(random), rate(random)}};
    Vector psi = closed.arm()->motors(closed.arm()->angles(pose) +
                                      Vector3d(nudge(random), nudge(random), nudge(random))),
           other = psi;
    ASSERT_EQ(closed.position(point.position, 0, psi), IkOutcome::solved);
    ASSERT_EQ(general.position(point.position, 0, other), IkOutcome::solved) << sample;
    EXPECT_LT((psi - other).cwiseQuotient(closed.motor_scale()).norm(), 1e-11) << sample;
    Vector psid, psidd, other_d, other_dd;
    ASSERT_EQ(closed.rates(point, 0, psi, psid, psidd), IkOutcome::solved);
    ASSERT_EQ(general.rates(point, 0, psi, other_d, other_dd), IkOutcome::solved);
    // The condition number of such poses stays below 1e3, in psidd squared.
    EXPECT_LT((psid - other_d).norm(), 1e-12 * psid.norm()) << sample;
    EXPECT_LT((psidd - other_dd).norm(), 1e-11 * psidd.norm()) << sample;
    // And forward again.
    const auto& E = closed.forward(psi, psid, psidd, 0);
    EXPECT_LT((E.velocity - point.velocity).norm(), 1e-12);
    EXPECT_LT((E.acceleration - point.acceleration).norm(), 1e-10);
  }
}

// Central differences in 113 bits of the closed form along the paper's line: step 1e-10 s, relative error
// 1e-14.
TEST(InverseKinematics, RatesAreTheDerivativesOfThePosition) {
  const auto model = paper_robot();
  InverseKinematics ik(model);
  const Itinerary itinerary(path_from(kPaperPath, model), 1000, 1);
  const auto& arm = *ik.arm();
  const Wide two_pi = 2 * acos(Wide(-1)), h(1e-10);
  const auto angles = [&](const Wide& t) {
    const Wide s = t - sin(two_pi * t) / two_pi;
    const auto on_line = [&](double from, double to) -> Wide { return (1 - s) * Wide(from) + s * Wide(to); };
    return arm_angles<Wide>(arm, {on_line(0.3, -0.3), on_line(0, 0.4), on_line(0.8, 0.3)});
  };
  Vector psi, psid, psidd;
  for (const int k : {1, 50, 250, 486, 500, 501, 777, 999}) {
    const PathPoint point = itinerary.at(k);
    ASSERT_EQ(ik.position_from_home(point.position, 0, psi), IkOutcome::solved);
    ASSERT_EQ(ik.rates(point, 0, psi, psid, psidd), IkOutcome::solved);
    const Wide t = Wide(k) / 1000;
    const auto before = angles(t - h), now = angles(t), after = angles(t + h);
    Vector3d rate, acceleration;
    for (std::size_t i = 0; i < 3; ++i) {
      rate[static_cast<int>(i)] = static_cast<double>(Wide((after[i] - before[i]) / (2 * h)));
      acceleration[static_cast<int>(i)] =
          static_cast<double>(Wide((after[i] - 2 * now[i] + before[i]) / (h * h)));
    }
    EXPECT_LT((arm.B * psid - rate).norm(), 1e-13 * rate.norm()) << k;
    EXPECT_LT((arm.B * psidd - acceleration).norm(), 1e-12 * acceleration.norm()) << k;
  }
}

TEST(InverseKinematics, SolvesPlanarArmsByTheGeneralMethod) {
  for (const char* text : {kPlanarArm, kUprightArm}) {
    const auto model = model_from(text);
    const int up = model.scene->end_effector.axes[1];
    InverseKinematics ik(model);
    Vector psi, psid, psidd;
    Vector3d point(1, 0, 0);
    point[up] = 1;
    ASSERT_EQ(ik.position_from_home(point, 0, psi), IkOutcome::solved);
    EXPECT_LT((psi - Eigen::Vector2d(0, kPi / 2)).norm(), 1e-15);
    // There the first link lies along x and the second stands on its end: b alone moves its tip along x.
    PathPoint motion{.position = point, .velocity = {-1, 0, 0}};
    ASSERT_EQ(ik.rates(motion, 0, psi, psid, psidd), IkOutcome::solved);
    EXPECT_LT((psid - Eigen::Vector2d(0, 1)).norm(), 1e-15);
    EXPECT_EQ(psidd.size(), 2);
    point[0] = 3;
    EXPECT_EQ(ik.position_from_home(point, 0, psi), IkOutcome::out_of_reach);
    EXPECT_NEAR(ik.miss(point, 0, psi), std::sqrt(10.0) - 2, 1e-6);
  }
}

// The elbow at home is bent to one side; the mirrored solution is another branch.
TEST(InverseKinematics, KeepsHomesBranchByTheGeneralMethod) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(-kPi, kPi), bent(0.05, kPi - 0.05);
  const auto model = model_from(kPlanarArm);
  InverseKinematics ik(model);
  const Vector zero = Vector::Zero(2);
  for (int sample = 0; sample < 300; ++sample) {
    const Vector pose = Eigen::Vector2d(angle(random), bent(random));
    const Vector3d point = ik.forward(pose, zero, zero, 0).position;
    Vector psi;
    ASSERT_EQ(ik.position_from_home(point, 0, psi), IkOutcome::solved) << sample;
    EXPECT_LT(ik.miss(point, 0, psi), 1e-14) << sample;
    EXPECT_GT(std::sin(psi[1]), 0) << sample;
  }
}

TEST(InverseKinematics, SolvesPrismaticScenesAndThoseThatMoveByThemselves) {
  const auto still = model_from(gantry(false));
  InverseKinematics ik(still);
  Vector psi, psid, psidd;
  ASSERT_EQ(ik.position_from_home({1, 2, 0.05}, 0, psi), IkOutcome::solved);
  EXPECT_LT((psi - Vector3d(10 * kPi, 1, 2)).norm(), 1e-13);

  // x = b + 0.1 sin(2 t): to stand still at x = 1, b = 1 - 0.1 sin(2 t).
  const auto moving = model_from(gantry(true));
  InverseKinematics on_ship(moving);
  const double t = 0.3;
  ASSERT_EQ(on_ship.position_from_home({1, 2, 0.05}, t, psi), IkOutcome::solved);
  EXPECT_LT((psi - Vector3d(10 * kPi, 1 - 0.1 * std::sin(0.6), 2)).norm(), 1e-13);
  ASSERT_EQ(on_ship.rates({.position = {1, 2, 0.05}}, t, psi, psid, psidd), IkOutcome::solved);
  EXPECT_LT((psid - Vector3d(0, -0.2 * std::cos(0.6), 0)).norm(), 1e-15);
  EXPECT_LT((psidd - Vector3d(0, 0.4 * std::sin(0.6), 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace mixloop
