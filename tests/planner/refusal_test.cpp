// SPDX-License-Identifier: MIT
// Paths that must not be started.
#include <gtest/gtest.h>

#include "planner/plan.hpp"
#include "planner/refusal.hpp"
#include "tests/planner/mechanisms.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

/// The plan must be refused with this code, and the message must have these parts.
void expect_refusal(const Model<double>& model, const std::string& path, const Plan::Settings& settings,
                    const std::string& code, const std::vector<std::string>& parts) {
  const auto error = input_error([&] { Plan(model, path_from(path, model), settings); });
  if (!error) return;
  EXPECT_EQ(error->code, code) << error->what();
  for (const auto& part : parts)
    EXPECT_NE(error->message.find(part), std::string::npos) << "'" << part << "' in: " << error->what();
}

std::string line(const std::string& from, const std::string& to, const std::string& rest = "duration: 1 s") {
  return "{line: {from: " + from + ", to: " + to + "}, " + rest + "}";
}

// From (0.3, 0, 0.3), on the shoulder's height, along x: the reach ends at 0.6 m, s = 1/2.
TEST(Refusal, OfAPathOutOfReachSaysWhereAndHowFar) {
  const auto model = paper_robot();
  expect_refusal(
      model, line("[0.3, 0, 0.3]", "[0.9, 0, 0.3]"), {}, "unreachable",
      {"0.5 s into the path", "0.5 of the line from (0.3, 0, 0.3) to (0.9, 0, 0.3) m, at (0.6, 0, 0.3) m",
       "0.9 m from the shoulder axis", "from 0 to 0.6 m"});
  expect_refusal(model, line("[0.9, 0, 0.3]", "[0.3, 0, 0.3]"), {}, "unreachable",
                 {"the path's start", "0.9 m from the shoulder axis"});
  const auto error = input_error([&] {
    Plan(model,
         path_from("{via: [{at: [0.3, 0, 0.3]}, {at: [0.4, 0, 0.3], duration: 1 s},\n {at: [0.9, 0, 0.3], "
                   "duration: 1 s}]}",
                   model),
         {});
  });
  EXPECT_EQ(to_string(error->place), "path.yaml:2:2");
}

TEST(Refusal, OfAPathOutOfReachKnowsNoArm) {
  expect_refusal(model_from(kPlanarArm), line("[1, 0]", "[3, 0]"), {}, "unreachable",
                 {"0.5 s into the path", "0.5 of the line", "1 m from the nearest"});
  expect_refusal(model_from(kPlanarArm), line("[3, 0]", "[1, 0]"), {}, "unreachable",
                 {"the path's start", "1 m from the nearest"});
}

// The rocker's end of a four-bar linkage gets to x = 0.36 m, where crank and coupler fold. Closures end on
// the way that a search takes beyond.
TEST(Refusal, OfAPathOutOfAClosedMechanismsReachSaysHowFar) {
  const auto model = model_of(load_scene(MIXLOOP_SCENES "/four_bar.yaml"));
  expect_refusal(model, line("[0.85]", "[0.3]"), {}, "unreachable",
                 {"at (0.36) m", "0.06 m from the nearest place that a search found"});
}

// Where all of the line can be reached, the follower's failure is no matter of reach.
TEST(Refusal, OfAWayThatTheMotorsDontKnowToWhatCanBeReachedIsOfASingularity) {
  const auto model = model_from(kPlanarArm);
  const Path path = path_from(line("[1, 0]", "[1.2, 0.3]"), model);
  const Itinerary itinerary(path, 1000, 1);
  InverseKinematics ik(model);
  SingularityMeasures measures(model, ik.motor_scale(), std::vector<int>{});
  const Refusal refusal(path, itinerary, &ik, measures);
  Follower follower(ik, itinerary, 0);
  ASSERT_EQ(follower.start([](const Vector&) { return true; }), IkOutcome::solved);
  measures.adopt_scale(follower.now().motors.psi, 0);
  const auto error = input_error([&] { refusal.no_way(follower, 5); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "singular_path");
  EXPECT_NE(error->message.find("singularity 'stretched'"), std::string::npos) << error->message;
}

TEST(Refusal, OfAPathOverTheBaseAxis) {
  const auto model = paper_robot();
  // Through it at a tick, between two ticks, and beside it by less than 1e-3 of home's 67 mm.
  for (const char* path : {"duration: 1 s", "duration: 1.001 s"})
    expect_refusal(model, line("[0.3, 0, 0.8]", "[-0.3, 0, 0.3]", path), {}, "singular_path",
                   {"'wrist over the base axis'", "0.5 of the line"});
  expect_refusal(model, line("[0.3, 0.00005, 0.8]", "[-0.3, 0.00005, 0.3]", "duration: 1.001 s"), {},
                 "singular_path", {"'wrist over the base axis'", "0.00074 of"});
  EXPECT_NO_THROW(Plan(model, path_from(line("[0.3, 0.01, 0.8]", "[-0.3, 0.01, 0.3]"), model), {}));
}

TEST(Refusal, OfAPathThatStartsAtTheFlatElbow) {
  expect_refusal(paper_robot(), line("[0.6, 0, 0.3]", "[0.3, 0, 0.3]"), {}, "singular_path",
                 {"'flat elbow'", "0 s into the path"});
}

// With the other elbow q4 = 138 deg - q5/2 passes 180 deg where q5 = -84 deg: 0.6 m cos(42 deg) = 0.445887 m
// from the shoulder, here of a line from 0.5 to 0.3 m, s = (0.5 - 0.445887) / 0.2.
TEST(Refusal, OfAPathThroughTheFlatParallelogram) {
  expect_refusal(
      paper_robot_elbow_down(), line("[0.5, 0, 0.3]", "[0.3, 0, 0.3]"), {}, "crosses_branch",
      {"crosses the singularity 'flat parallelogram'", "0.2706 of the line", "(0.445887, 0, 0.3)"});
  EXPECT_NO_THROW(Plan(paper_robot(), path_from(line("[0.5, 0, 0.3]", "[0.3, 0, 0.3]"), paper_robot()), {}));
}

// The same scene without names: the Jacobian tells of the axis.
TEST(Refusal, OfASingularPathThatTheSceneDoesNotName) {
  expect_refusal(paper_robot({{"singularities", "{}"}}),
                 line("[0.3, 0, 0.8]", "[-0.3, 0, 0.3]", "duration: 1.001 s"), {}, "singular_path",
                 {"of the end effector's Jacobian"});
}

// Through the axis between two ticks Newton's method goes on with the slide drawn back to the other side,
// another branch; at a tick there is no going on. Beside the axis it has to turn by half a turn within a
// tick; 2 mm away that is seen and allowed.
TEST(Refusal, OfASingularPathByTheGeneralMethod) {
  const auto model = model_from(kTurningSlide);
  const std::string jacobian = "of the end effector's Jacobian";
  expect_refusal(model, line("[1, 0]", "[-1, 0]"), {}, "singular_path", {"0.5 of the line", jacobian});
  expect_refusal(model, line("[1, 0]", "[-1, 0]", "duration: 1.001 s"), {}, "crosses_branch",
                 {"0.5 of the line", jacobian});
  for (const char* duration : {"duration: 1 s", "duration: 1.001 s", "duration: 0.1 s"})
    expect_refusal(model, line("[1, 0.0005]", "[-1, 0.0005]", duration), {}, "singular_path",
                   {"0.5 of the line", "of the end effector's Jacobian", "0.0005"});
  EXPECT_NO_THROW(Plan(model, path_from(line("[1, 0.002]", "[-1, 0.002]"), model), {}));
}

// At 2 mm from the axis the slide's motor turns at 4 m/s / 2 mm = 2000 rad/s; a tick of 1 ms is longer than
// that lasts, and the references at the ticks beside it are slower.
TEST(Refusal, OfAJumpBetweenTicks) {
  const auto model = model_from(kTurningSlide);
  expect_refusal(model, line("[1, 0.0015]", "[-1, 0.0015]", "duration: 0.101 s"),
                 {.limits = {.velocity = {2500, 1000}}}, "over_limit", {"the motor a"});
}

// A path that home's elbow reaches, but the parallelogram of home does not: its start lies across.
TEST(Refusal, OfAPathOnAnotherBranchThanHomes) {
  expect_refusal(paper_robot_elbow_down(), line("[0.3, 0, 0.3]", "[0.25, 0, 0.3]"), {}, "crosses_branch",
                 {"0 s into the path", "'flat parallelogram'"});
}

TEST(Refusal, OfAPathOverALimit) {
  const auto model = paper_robot();
  expect_refusal(model, kPaperPath, {.limits = {.velocity = {1000, 50, 1000}}}, "over_limit",
                 {"psi2", "rad/s", "its limit of 50 rad/s", " s into the path"});
  expect_refusal(model, kPaperPath, {.limits = {.torque = {5, 4, 5}}}, "over_limit",
                 {"psi2", "N m", "its limit of 4 N m"});
  EXPECT_NO_THROW(Plan(model, path_from(kPaperPath, model),
                       {.limits = {.velocity = {1000, 1000, 1000}, .torque = {50, 50, 50}}}));
  expect_refusal(model, kPaperPath, {.limits = {.torque = {1, 1}}}, "wrong_size", {"2 values"});
  expect_refusal(model, kPaperPath, {.limits = {.velocity = {1, 0, 1}}}, "out_of_range", {"more than 0"});
}

// By hand: 2 kg lifted by a spindle of 10 mm a turn against 10 m/s^2 takes 20 N * 10 mm / 2 pi = 0.0318 N m
// at rest.
TEST(Refusal, OfATorqueOverItsLimitIsByInverseDynamics) {
  const auto model = model_from(gantry(false));
  expect_refusal(model, line("[0, 0, 0]", "[0, 0, 0]"), {.limits = {.torque = {0.0318, 100, 100}}},
                 "over_limit", {"the motor a would need 0.031831 N m"});
  EXPECT_NO_THROW(Plan(model, path_from(line("[0, 0, 0]", "[0, 0, 0]"), model),
                       {.limits = {.torque = {0.0319, 100, 100}}}));
}

TEST(Refusal, OfAMoveToTheStart) {
  const auto model = paper_robot();
  const auto& scene = *model.scene;
  ASSERT_EQ(scene.n(), 3);
  // From q5 = -44 deg, over the flat elbow.
  const Vector down = Eigen::Map<const Vector>(paper_robot_elbow_down().scene->home.data(), 3);
  expect_refusal(model, kPaperPath, {.start_psi = {down.begin(), down.end()}}, "crosses_branch",
                 {"the move to the path's start", "'flat elbow'"});
  expect_refusal(model, line("[0.3, 0, 0.8]", "[-0.3, 0.4, 0.3]", "duration: 4 s, approach: 0.1 s"),
                 {.limits = {.velocity = {60, 60, 60}}, .start_psi = {8, -14, 18}}, "over_limit",
                 {"the move to the path's start, which takes 0.1 s", "psi1", "longer 'approach'"});
  expect_refusal(model, kPaperPath, {.start_psi = {1, 2}}, "wrong_size", {"2 values"});
  expect_refusal(model, line("[0.3, 0, 0.8]", "[-0.3, 0.4, 0.3]", "duration: 1 s, approach: 0.1234 s"),
                 {.start_psi = {1, -14, 18}}, "off_grid", {"the approach"});
}

TEST(Refusal, OfWhatWouldNotFit) {
  const auto model = paper_robot();
  expect_refusal(model, kPaperPath, {.rate_hz = 1e8}, "too_large", {"1 GB"});
  expect_refusal(model, kPaperPath, {.rate_hz = 0}, "out_of_range", {"rate"});
  expect_refusal(model, kPaperPath, {.rate_hz = 999.5}, "off_grid", {"999.5 ticks"});
}

}  // namespace
}  // namespace mixloop
