// SPDX-License-Identifier: MIT
// Transforms as poses and joints, tables in Craig's order, motors that transforms name themselves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/procedure.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

Scene scene_from(const std::string& text, const std::string& file = "poses.yaml") {
  return load_scene(parse_document(text, file));
}

/// With a body and an end effector on the frame `tip`.
std::string arm_of(const std::string& motors, const std::string& transforms) {
  return "motors: " + motors + "\nparameters: {reach: 0.3 m, lean: 20 deg}\ntransforms:\n" + transforms +
         "bodies: [{frame: tip, mass: 1 kg}]\nend_effector: {frame: tip}\n";
}

/// The end effector's frame at psi.
Isometry3d tip_at(const Scene& scene, const std::vector<double>& psi) {
  const auto shared = std::make_shared<const Scene>(scene);
  const std::vector<double> parameters = scene.default_parameters();
  const auto model = make_model<double>(shared, std::span<const double>(parameters));
  Workspace<double> ws(model);
  coordinates<double>(model, psi, 0.0, ws);
  frame_variations(model, ws);
  Isometry3d tip = Isometry3d::Identity();
  tip.affine() = ws.frames[static_cast<std::size_t>(scene.end_effector.frame)].T_0;
  return tip;
}

/// Trans(at) Rz(yaw) Ry(pitch) Rx(roll)
Isometry3d pose(const Vector3d& at, const Vector3d& rpy) {
  return Eigen::Translation3d(at) * AngleAxisd(rpy[2], Vector3d::UnitZ()) *
         AngleAxisd(rpy[1], Vector3d::UnitY()) * AngleAxisd(rpy[0], Vector3d::UnitX());
}

std::string listed(const Vector3d& x) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]); }

void expect_same(const Isometry3d& found, const Isometry3d& expected, const std::string& what) {
  EXPECT_LT((found.matrix() - expected.matrix()).norm(), 4e-15) << what;  // some roundings of numbers below 2
}

// By Eigen's own turns, with right angles and zeros among the numbers.
TEST(Poses, AreTranslationThenYawPitchRollThenTheJointAboutOrAlongItsAxis) {
  std::mt19937_64 random(1);
  const auto number = [&](double size) { return size * (static_cast<double>(random() % 2049) / 1024 - 1); };
  const auto draw = [&](double size, double step) {
    Vector3d x(number(size), number(size), number(size));
    for (Eigen::Index i = 0; i < 3; ++i)
      if (random() % 2 == 0) x[i] = step * static_cast<double>(static_cast<int>(random() % 5) - 2);
    return x;
  };
  for (int k = 0; k < 400; ++k) {
    const Vector3d at = draw(1, 0.5), rpy = draw(3, std::numbers::pi / 2);
    Vector3d axis = draw(1, 1);
    if (axis.isZero()) axis = Vector3d::UnitZ();
    const double psi = number(3);
    const bool slides = random() % 3 == 0;
    const std::string text =
        arm_of(slides ? "{psi: linear}" : "[psi]",
               fmt::format("  - {{from: 0, to: tip, at: {}, rpy: {}, {}: {}, axis: {}}}\n", listed(at),
                           listed(rpy), slides ? "prismatic" : "revolute",
                           slides ? "2*psi + 10 cm" : "0.5*psi - 10 deg", listed(axis)));
    const Vector3d along = axis.normalized();
    const Isometry3d joint = slides ? Isometry3d(Eigen::Translation3d((2 * psi + 0.1) * along))
                                    : Isometry3d(AngleAxisd(0.5 * psi - std::numbers::pi / 18, along));
    expect_same(tip_at(scene_from(text), {psi}), pose(at, rpy) * joint, text);
  }
}

TEST(Poses, MayDependOnParametersAndStandBesideDenavitAndHartenberg) {
  const Scene scene = scene_from(arm_of(
      "[a, b]",
      "  - {from: up, to: arm, at: [0, -reach, 2*reach], rpy: [0, lean, 90 deg], revolute: b, axis: x}\n"
      "  - {from: 0, to: up, theta: a, s: 0.5, alpha: 90 deg}\n"
      "  - {from: arm, to: tip, at: [0.1, 0.2, 0]}\n"));
  const double lean = std::numbers::pi / 9, right = std::numbers::pi / 2;
  const Isometry3d up = Eigen::Translation3d(0, 0, 0.5) * AngleAxisd(0.7, Vector3d::UnitZ()) *
                        AngleAxisd(right, Vector3d::UnitX());
  const Isometry3d arm = pose({0, -0.3, 0.6}, {0, lean, right}) * AngleAxisd(-0.4, Vector3d::UnitX());
  expect_same(tip_at(scene, {0.7, -0.4}), up * arm * Eigen::Translation3d(0.1, 0.2, 0), "arm");
}

TEST(Poses, AxesMayBeNamedAndAreZUnlessGiven) {
  const auto of = [](const std::string& joint) {
    return tip_at(scene_from(arm_of("[psi]", "  - {from: 0, to: tip, revolute: psi" + joint + "}\n")), {0.6});
  };
  expect_same(of(""), Isometry3d(AngleAxisd(0.6, Vector3d::UnitZ())), "z");
  expect_same(of(", axis: x"), Isometry3d(AngleAxisd(0.6, Vector3d::UnitX())), "x");
  expect_same(of(", axis: y"), Isometry3d(AngleAxisd(0.6, Vector3d::UnitY())), "y");
  expect_same(of(", axis: [0, -3, 0]"), Isometry3d(AngleAxisd(-0.6, Vector3d::UnitY())), "-y");
}

// One transform of for what is one, and no more than the pose's zeros ask for.
TEST(Poses, TakeAsFewTransformsAsTheyCan) {
  const auto count = [](const std::string& entry) {
    return scene_from(arm_of("[psi]", "  - {from: 0, to: tip, " + entry + "}\n")).transforms.size();
  };
  EXPECT_EQ(count("revolute: psi"), 1U);
  EXPECT_EQ(count("at: [0, 0, 1], revolute: psi"), 1U);
  EXPECT_EQ(count("at: [0, 0, 1], rpy: [90 deg, 0, 0], revolute: psi, axis: y"), 1U);
  EXPECT_EQ(count("revolute: psi, axis: [0, 0, -1]"), 1U);
  EXPECT_EQ(count("at: [1, 0, 2], rpy: [30 deg, 0, 0], revolute: psi"), 2U);
  EXPECT_EQ(count("at: [1, 2, 3], rpy: [0.1, 0.2, 0.3], revolute: psi"), 5U);
}

TEST(Poses, TheFramesAmidOneHaveNoNameAndNobodyCanNameThem) {
  const std::string text = arm_of("[psi]", "  - {from: 0, to: tip, at: [1, 2, 3], revolute: psi}\n");
  const Scene scene = scene_from(text);
  EXPECT_EQ(scene.frames, (std::vector<std::string>{"0", "", "", "tip"}));
  const auto error =
      input_error([&] { scene_from(text + "solids: [{frame: '', shape: sphere, radius: 1}]\n"); });
  EXPECT_EQ(error->code, "broken_path");
  EXPECT_NE(error->message.find("expected one of '0', 'tip'"), std::string::npos) << error->message;
}

// Craig's table: Rx(alpha) Tx(a) Rz(theta) Tz(d).
TEST(Poses, TablesMayBeInCraigsOrder) {
  std::string text = arm_of("[a, b]",
                            "  - {from: 0, to: 1, a: 0.2, alpha: 40 deg, theta: a, s: 0.3}\n"
                            "  - {from: 1, to: 2, alpha: -90 deg, theta: b + 10 deg, s: 0.1}\n"
                            "  - {from: 2, to: tip, at: [0, 0.4, 0]}\n");
  const double degree = std::numbers::pi / 180;
  const auto row = [&](double alpha, double a, double theta, double d) {
    return Isometry3d(AngleAxisd(alpha * degree, Vector3d::UnitX()) * Eigen::Translation3d(a, 0, 0) *
                      AngleAxisd(theta, Vector3d::UnitZ()) * Eigen::Translation3d(0, 0, d));
  };
  expect_same(tip_at(scene_from("convention: modified\n" + text), {0.5, -0.8}),
              row(40, 0.2, 0.5, 0.3) * row(-90, 0, -0.8 + 10 * degree, 0.1) * Eigen::Translation3d(0, 0.4, 0),
              "modified");
  EXPECT_EQ(scene_from("convention: standard\n" + text).canonical, scene_from(text).canonical);
}

// What stands under `coordinates` and `constraints` for it is the same mechanism.
TEST(Poses, TransformsMayNameMotorsThemselves) {
  const std::string rest =
      "bodies: [{frame: tip, mass: 1 kg}]\nend_effector: {frame: tip}\ntransforms:\n  - {from: 0, to: up, "
      "s: ";
  const Scene scene =
      scene_from("motors: {x: linear, a: rotary}\n" + rest +
                 "x}\n  - {from: up, to: mid, theta: -2*a + 1, a: 1}\n  - {from: mid, to: tip, "
                 "theta: a, a: 1}\n");
  ASSERT_EQ(scene.m(), 2);
  EXPECT_EQ(scene.coordinates[0].name, "x");
  EXPECT_EQ(scene.coordinates[1].name, "a");
  EXPECT_EQ(
      scene.canonical,
      scene_from("motors: {x: linear, a: rotary}\ncoordinates: [p, q]\nconstraints: {p: x, q: a}\n" + rest +
                 "p}\n  - {from: up, to: mid, theta: -2*q + 1, a: 1}\n  - {from: mid, to: tip, theta: q, "
                 "a: 1}\n")
          .canonical);
}

TEST(Poses, ASceneInWhichNothingMovesIsRead) {
  EXPECT_EQ(scene_from(arm_of("[psi]", "  - {from: 0, to: tip, at: [1, 0, 0]}\n")).m(), 0);
}

const std::string kArm =
    arm_of("[a, b]",
           "  - {from: 0, to: up, at: [0, 0, 1], rpy: [lean, 0, 0], revolute: 2*a, axis: y}\n"
           "  - {from: up, to: tip, theta: b}\n") +
    "coordinates: [q]\nconstraints: {q: a*b}\n";

std::string spoilt(const std::string& part, const std::string& other) {
  std::string text = kArm;
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), other);
}

class RefusedPose : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedPose, WithItsPlace) {
  expect_refused(GetParam(),
                 [](const std::string& text, const std::string& file) { scene_from(text, file); });
}

INSTANTIATE_TEST_SUITE_P(
    Poses, RefusedPose,
    testing::Values(
        BadInput{"BesideDenavitAndHartenberg", spoilt("at: [0, 0, 1]", "theta: a, at: @[0, 0, 1]"),
                 "doubly_defined",
                 "a transform has 'at', of a pose, beside 'theta', one of Denavit and Hartenberg's numbers; "
                 "expected one or the other"},
        BadInput{"JointBesideDenavitAndHartenberg", spoilt("theta: b", "s: 1, revolute: @b"),
                 "doubly_defined", "a transform has 'revolute', of a pose, beside 's'"},
        BadInput{"TwoJoints", spoilt("revolute: 2*a", "revolute: 2*a, prismatic: @b"), "doubly_defined",
                 "a joint is 'revolute' and 'prismatic'; expected one of them"},
        BadInput{"AxisWithoutJoint", spoilt("revolute: 2*a, axis: y", "axis: @y"), "missing_key",
                 "an axis without a joint; expected 'revolute' or 'prismatic' beside it"},
        BadInput{"NoDirection", spoilt("axis: y", "axis: @[0, 0, 0]"), "out_of_range",
                 "the axis is [0, 0, 0]; expected a direction"},
        BadInput{"UnknownAxis", spoilt("axis: y", "axis: @w"), "unknown_value", "the axis is 'w'"},
        BadInput{"AxisOfTwo", spoilt("axis: y", "axis: @[0, 1]"), "wrong_size",
                 "found a list of 2; expected the axis x, y, z, or a vector"},
        BadInput{"AxisOfAParameter", spoilt("axis: y", "axis: [0, @lean, 1]"), "varying_number",
                 "an axis depends on no parameter; expected numbers"},
        BadInput{"AxisInMetres", spoilt("axis: y", "axis: [0, @1 m, 0]"), "wrong_dimension", "the axis"},
        BadInput{
            "JointThatNeverMoves", spoilt("revolute: 2*a", "revolute: @30 deg + lean"), "varying_number",
            "'revolute' names no coordinate; expected a formula that is affine in one, or 'at' and 'rpy' "
            "alone for what never moves"},
        BadInput{"JointOfTheTime", spoilt("revolute: 2*a", "revolute: @a + t / 1 s"), "varying_number",
                 "by coordinates only, not by time directly"},
        BadInput{"CurvedJoint", spoilt("revolute: 2*a", "revolute: @a^2"), "varying_number",
                 "not affine in 'a'; put the formula into its constraint"},
        BadInput{"JointOfTwo", spoilt("revolute: 2*a", "revolute: @a + b"), "varying_number",
                 "a second varying coordinate 'b' in one transform; expected at most one"},
        BadInput{"JointOfTwoKinds", spoilt("theta: b", "theta: @q + b"), "varying_number",
                 "a second varying coordinate"},
        BadInput{"RevoluteInMetres", spoilt("revolute: 2*a", "revolute: @a * 1 m"), "wrong_dimension",
                 "'revolute' is a length (m); expected a number or an angle"},
        BadInput{"PrismaticInRadians", spoilt("revolute: 2*a", "prismatic: @a"), "wrong_dimension",
                 "'prismatic' is a number or an angle; expected a length (m)"},
        BadInput{"MovingPose", spoilt("at: [0, 0, 1]", "at: [0, 0, @a]"), "undefined_symbol",
                 "undefined symbol 'a'"},
        BadInput{"PoseOfTwo", spoilt("at: [0, 0, 1]", "at: @[0, 1]"), "wrong_size",
                 "found a list of 2; expected 'at' as [x, y, z]"},
        BadInput{"TurnInMetres", spoilt("rpy: [lean", "rpy: [@1 m"), "wrong_dimension",
                 "'rpy' (roll, pitch, yaw) is a length (m)"},
        BadInput{"MisspeltKey", spoilt("rpy:", "@rpi:"), "unknown_key",
                 "unknown key 'rpi' in a transform; did you mean 'rpy'?"},
        BadInput{"UnknownConvention", "convention: @craig\n" + kArm, "unknown_value",
                 "the convention is 'craig'"},
        BadInput{"CurvedInCraigsTable", "convention: modified\n" + spoilt("theta: b", "alpha: @b"),
                 "varying_number", "a and alpha are constant; 'b' may vary theta or s"},
        BadInput{"FrameWithoutAName", spoilt("to: up", "to: @''"), "invalid_name",
                 "a frame without a name; expected one"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
