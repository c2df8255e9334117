// SPDX-License-Identifier: MIT
// Paths of mechanisms with more motors than axes, of those that are turned along the way, and of the motors
// alone.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "planner/orientation.hpp"
#include "planner/plan.hpp"
#include "tests/planner/mechanisms.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

/// Three links of 1 m, 0.8 m and 0.5 m in the plane x, y.
std::string planar_arm(const std::string& end_effector) {
  return R"(
motors: [a, b, c]
transforms:
  - {from: 0, to: 1, theta: a, a: 1 m}
  - {from: 1, to: 2, theta: b, a: 0.8 m}
  - {from: 2, to: hand, theta: c, a: 0.5 m}
bodies: [{frame: hand, mass: 1 kg}]
gravity: [0, 0, 0]
home: {a: 10 deg, b: 40 deg, c: 50 deg}
end_effector: {frame: hand, )" +
         end_effector + "}\n";
}

/// Six joints of a robot with a wrist, its axes as those of a PUMA 560 (m).
std::string six_joints(const std::string& end_effector) {
  return R"(
motors: [m1, m2, m3, m4, m5, m6]
transforms:
  - {from: 0, to: 1, theta: m1, alpha: 90 deg}
  - {from: 1, to: 2, theta: m2, a: 0.4318}
  - {from: 2, to: 3, theta: m3, s: 0.15, a: 0.0203, alpha: -90 deg}
  - {from: 3, to: 4, theta: m4, s: 0.4318, alpha: 90 deg}
  - {from: 4, to: 5, theta: m5, alpha: -90 deg}
  - {from: 5, to: hand, theta: m6, s: 0.1}
bodies: [{frame: hand, mass: 1 kg}]
home: {m1: 10 deg, m2: 20 deg, m3: -60 deg, m4: 15 deg, m5: 50 deg, m6: 5 deg}
end_effector: {frame: hand, )" +
         end_effector + "}\n";
}

/// How the hand is turned, and how it turns, by the motors' references.
HandTurns turns_at(HandKinematics& hand, const Reference& reference) {
  return hand.turns_at(reference.psi, reference.psid, reference.psidd, 0);
}

/// psid and psidd are the rates of psi and psid: by differences of fourth order over a tick.
void expect_rates(const Plan& plan, double rate, double tolerance) {
  double most = 1;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k)
    most = std::max(most, plan.at(k).psidd.cwiseAbs().maxCoeff());
  for (std::int64_t k = 2; k + 2 <= plan.ticks(); k += 7) {
    const auto slope = [&](auto of) {
      return Vector((8 * (of(k + 1) - of(k - 1)) - (of(k + 2) - of(k - 2))) * rate / 12);
    };
    const Vector psid = slope([&](std::int64_t i) { return Vector(plan.at(i).psi); });
    const Vector psidd = slope([&](std::int64_t i) { return Vector(plan.at(i).psid); });
    EXPECT_LT((psid - plan.at(k).psid).cwiseAbs().maxCoeff(), tolerance * most) << k;
    EXPECT_LT((psidd - plan.at(k).psidd).cwiseAbs().maxCoeff(), tolerance * most) << k;
  }
}

void expect_on_path(const Model<double>& model, const Plan& plan, const std::vector<int>& axes) {
  HandKinematics hand(model);
  for (std::int64_t k = 0; k <= plan.ticks(); k += 5) {
    const Reference now = plan.at(k);
    const auto& state = hand.at(now.psi, now.psid, now.psidd, 0);
    for (const int axis : axes) {
      EXPECT_NEAR(state.position[axis], now.position[axis], 1e-12) << k;
      EXPECT_NEAR(state.velocity[axis], now.velocity[axis], 1e-11) << k;
      EXPECT_NEAR(state.acceleration[axis], now.acceleration[axis], 1e-9) << k;
    }
  }
}

constexpr const char* kReach = "{line: {from: [1.2, 0.6], to: [0.6, 1.3]}, duration: 0.5 s";

TEST(RedundantPath, HoldsMotorsAtHome) {
  const auto model = model_from(planar_arm("axes: [x, y]"));
  const Plan plan = plan_of(model, std::string(kReach) + ", hold: [c]}");
  expect_on_path(model, plan, {0, 1});
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) EXPECT_EQ(plan.at(k).psi[2], 50 * std::numbers::pi / 180);
  expect_rates(plan, 1000, 1e-8);
}

// The least velocity of those that serve: none of it goes along the motors' freedom, the cross product of the
// Jacobian's rows, in units of the motors' scale.
TEST(RedundantPath, IsOfLeastVelocity) {
  const auto model = model_from(planar_arm("axes: [x, y]"));
  const Plan plan = plan_of(model, std::string(kReach) + ", redundancy: least_norm}");
  expect_on_path(model, plan, {0, 1});
  expect_rates(plan, 1000, 1e-8);
  HandKinematics hand(model);
  for (std::int64_t k = 0; k <= plan.ticks(); k += 20) {
    const Reference now = plan.at(k);
    const Matrix J = hand.at(now.psi, now.psid, now.psidd, 0).jacobian;
    const Vector3d scale = hand.motor_scale();
    const Vector3d x = J.row(0).transpose().cwiseProduct(scale), y = J.row(1).transpose().cwiseProduct(scale);
    EXPECT_NEAR(x.cross(y).normalized().dot(Vector3d(now.psid.cwiseQuotient(scale))), 0, 1e-9) << k;
  }
}

// There and back the motors come back to where they were, and each lap is the same.
TEST(RedundantPath, ComesBack) {
  const auto model = model_from(planar_arm("axes: [x, y]"));
  const Plan plan = plan_of(model,
                            "{via: [{at: [1.2, 0.6]}, {at: [0.6, 1.3], duration: 0.2 s}, {at: [0.2, 1.5], "
                            "duration: 0.2 s}], repeat: 1, "
                            "redundancy: least_norm}");
  EXPECT_LT((plan.at(plan.ticks()).psi - plan.at(0).psi).norm(), 1e-10);
}

TEST(RedundantPath, IsOfLeastVelocityInSpaceAndDirection) {
  const auto model = model_from(six_joints("axes: [x, y, z], direction: z"));
  const Plan plan = plan_of(
      model,
      "{line: {from: [0.5, 0.1, 0.3], to: [0.45, -0.2, 0.45]}, duration: 0.5 s, redundancy: least_norm}");
  expect_on_path(model, plan, {0, 1, 2});
  expect_rates(plan, 1000, 1e-7);
  HandKinematics hand(model);
  const Vector3d home = hand.turns_at(hand.home(), hand.rest(), hand.rest(), 0).rotation.col(2);
  for (std::int64_t k = 0; k <= plan.ticks(); k += 5)
    EXPECT_LT((turns_at(hand, plan.at(k)).rotation.col(2) - home).norm(), 1e-12) << "kept as at home, " << k;
}

TEST(RedundantPath, TurnsADirectionAlongTheShortestWay) {
  const auto model = model_from(six_joints("axes: [x, y, z], direction: [0, 0, 2]"));
  HandKinematics hand(model);
  const Vector3d from = hand.turns_at(hand.home(), hand.rest(), hand.rest(), 0).rotation.col(2);
  const Vector3d to = (from + Vector3d(0.2, -0.3, 0.1)).normalized();
  const Plan plan =
      plan_of(model, fmt::format("{{via: [{{at: [0.5, 0.1, 0.3]}}, {{at: [0.45, 0, 0.4], direction: "
                                 "[{:.17g}], duration: 0.5 s}}], hold: [m6]}}",
                                 fmt::join(to, ", ")));
  expect_rates(plan, 1000, 1e-7);
  const auto pointing = [&](std::int64_t k) { return Vector3d(turns_at(hand, plan.at(k)).rotation.col(2)); };
  EXPECT_LT((pointing(0) - from).norm(), 1e-12) << "as at home";
  EXPECT_LT((pointing(500) - to).norm(), 1e-12);
  EXPECT_LT((pointing(250) - (from + to).normalized()).norm(), 1e-12)
      << "half of the way at half of the time";
}

TEST(TurnedPath, HasItsRollPitchAndYaw) {
  const auto model = model_from(six_joints("axes: [x, y, z, rx, ry, rz]"));
  const Plan plan = plan_of(model,
                            "{line: {from: [0.45, 0.1, 0.4, 150 deg, 10 deg, 20 deg], to: [0.4, -0.1, 0.45, "
                            "170 deg, -10 deg, 40 deg]}, "
                            "duration: 0.5 s}");
  expect_on_path(model, plan, {0, 1, 2});
  expect_rates(plan, 1000, 1e-7);
  HandKinematics hand(model);
  constexpr double kDegree = std::numbers::pi / 180;
  const auto rpy = [](double roll, double pitch, double yaw) {
    return (Eigen::AngleAxisd(yaw * kDegree, Vector3d::UnitZ()) *
            Eigen::AngleAxisd(pitch * kDegree, Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll * kDegree, Vector3d::UnitX()))
        .toRotationMatrix();
  };
  EXPECT_LT((turns_at(hand, plan.at(0)).rotation - rpy(150, 10, 20)).norm(), 1e-12);
  EXPECT_LT((turns_at(hand, plan.at(500)).rotation - rpy(170, -10, 40)).norm(), 1e-12);
  const auto half = Eigen::Quaterniond(rpy(150, 10, 20)).slerp(0.5, Eigen::Quaterniond(rpy(170, -10, 40)));
  EXPECT_LT((turns_at(hand, plan.at(250)).rotation - half.toRotationMatrix()).norm(), 1e-12);
}

TEST(TurnedPath, OfAPlanarArmHasOneAngle) {
  const auto model = model_from(planar_arm("axes: [x, y, rz]"));
  const Plan plan = plan_of(model, "{line: {from: [1.2, 0.6, 0], to: [0.9, 1.0, 30 deg]}, duration: 0.5 s}");
  expect_on_path(model, plan, {0, 1});
  expect_rates(plan, 1000, 1e-8);
  constexpr double kHome = 100 * std::numbers::pi / 180;
  EXPECT_NEAR(plan.at(0).psi.sum(), kHome, 1e-12) << "as at home";
  EXPECT_NEAR(plan.at(500).psi.sum(), kHome + std::numbers::pi / 6, 1e-12);
}

TEST(HandKinematics, TurnsAsItsRotationChanges) {
  const auto model = model_from(six_joints("axes: [x, y, z, rx, ry, rz]"));
  HandKinematics hand(model);
  Vector psid(6), psidd(6);
  psid << 0.3, -0.2, 0.5, 0.7, -0.4, 0.9;
  psidd << 1, -2, 0.5, 0.3, 2, -1;
  const auto at = [&](double t) {
    return hand.turns_at(hand.home() + t * psid + t * t / 2 * psidd, psid + t * psidd, psidd, 0);
  };
  constexpr double h = 1e-4;
  const HandTurns now = at(0);
  const Vector3d spin = rotation_vector(at(h).rotation * at(-h).rotation.transpose()) / (2 * h);
  EXPECT_LT((spin - now.spin).norm(), 1e-7);
  EXPECT_LT(((at(h).spin - at(-h).spin) / (2 * h) - now.spin_rate).norm(), 1e-6);
  EXPECT_LT((now.jacobian * psid - now.spin).norm(), 1e-14);
}

TEST(MotorPath, RunsThroughItsPoints) {
  const auto model = model_from(planar_arm("axes: [x, y]"));
  const Plan plan =
      plan_of(model, "{motors: [{at: [0, 0, 0], dwell: 0.1 s}, {at: [1, -0.5, 90 deg], duration: 0.5 s}]}");
  EXPECT_EQ(plan.ticks(), 600);
  EXPECT_EQ(plan.at(50).psi, Vector::Zero(3));
  EXPECT_EQ(plan.at(600).psi[1], -0.5);
  EXPECT_NEAR(plan.at(350).psi[2], std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(plan.at(350).psid[0], 4, 1e-12) << "the cycloid's peak, twice the mean";
  expect_on_path(model, plan, {0, 1});
}

TEST(MotorPath, NeedsNoEndEffector) {
  const auto model = model_from(
      "motors: [a]\ntransforms: [{from: 0, to: 1, theta: a}]\n"
      "bodies: [{frame: 1, mass: 1 kg, center_of_mass: [1, 0, 0]}]");
  const Plan plan = plan_of(model, "{motors: [{at: [0]}, {at: [1]}], duration: 1 s}");
  EXPECT_TRUE(plan.has_path());
  EXPECT_TRUE(plan.at(500).position.hasNaN());
  EXPECT_NEAR(plan.at(500).psi[0], 0.5, 1e-15);
}

void expect_refusal(const std::string& scene, const std::string& path, const Plan::Settings& settings,
                    const std::string& code, const std::vector<std::string>& parts) {
  const auto model = model_from(scene);
  const auto error = input_error([&] { plan_of(model, path, settings); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, code);
  for (const auto& part : parts) EXPECT_THAT(error->message, HasSubstr(part));
}

TEST(AnyMechanism, SaysWhichNumberIsMissing) {
  expect_refusal(
      planar_arm("axes: [x, y]"), std::string(kReach) + "}", {}, "no_inverse",
      {"prescribes 2 numbers of the end effector (x, y)", "has 3 motors", "1 more", "`hold: [...]`"});
  expect_refusal(planar_arm("axes: [x, y]"), std::string(kReach) + ", hold: [b, c]}", {}, "no_inverse",
                 {"2 of them held", "too few, by 1"});
  expect_refusal(planar_arm("axes: [x, y], direction: x"), std::string(kReach) + "}", {}, "no_inverse",
                 {"4 numbers of the end effector (x, y, the two of its direction)", "too few, by 1"});
  expect_refusal(six_joints("axes: [x, y, z, rz]"),
                 "{line: {from: [0.5, 0, 0.3, 0], to: [0.4, 0, 0.3, 0]}, duration: 1 s, "
                 "hold: [m4, m6]}",
                 {}, "other_turns", {"about z alone", "turns about x too", "rx, ry, rz"});
}

TEST(AnyMechanism, KeepsItsMotorsWithinTheirLimits) {
  const std::string path = "{motors: [{at: [0, 0, 0]}, {at: [1, -0.5, 1], duration: 0.5 s}]}";
  const auto limits = [](double most) {
    return Plan::Settings{.limits = {.position = {{-2, 2}, {-most, most}, {-2, 2}}}};
  };
  expect_refusal(planar_arm("axes: [x, y]"), path, limits(0.4), "over_limit",
                 {"the motor b would stand at -0.5 rad; its limits are -0.4 to 0.4 rad"});
  const auto model = model_from(planar_arm("axes: [x, y]"));
  EXPECT_NO_THROW(plan_of(model, path, limits(0.5)));
}

// Stretched along x, no motor moves the hand along x.
TEST(AnyMechanism, SaysWhatASingularPoseCantDo) {
  expect_refusal(planar_arm("axes: [x, y]"),
                 "{line: {from: [1.5, 0], to: [2.301, 0]}, duration: 0.5 s, hold: [c]}", {}, "unreachable",
                 {"it leaves what can be reached"});
  const std::string straight = planar_arm("axes: [x, y, rz]");
  expect_refusal(
      straight, "{line: {from: [1.2, 0.6, -100 deg], to: [2.29999999, 0, -100 deg]}, duration: 0.5 s}", {},
      "singular_path",
      {"of the end effector's Jacobian", "it can't move along (1, 0, 0)", "whatever a, b, c do together"});
}

TEST(AnyMechanism, RefusesAHalfTurnThatMayGoEitherWay) {
  expect_refusal(planar_arm("axes: [x, y, rz]"),
                 "{line: {from: [1.2, 0.6, 0], to: [0.9, 1.0, 180 deg]}, duration: 0.5 s}", {},
                 "out_of_range", {"half a turn", "a via point between"});
}

TEST(MotorPath, IsRefusedWhereClosuresEnd) {
  const auto model = model_of(load_scene(MIXLOOP_SCENES "/four_bar_rocker.yaml"));
  const auto error =
      input_error([&] { plan_of(model, "{motors: [{at: [80 deg]}, {at: [280 deg], duration: 1 s}]}"); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "unreachable");
  EXPECT_THAT(error->message, HasSubstr("closures can't be closed"));
}

}  // namespace
}  // namespace mixloop
