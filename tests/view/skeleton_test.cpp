// SPDX-License-Identifier: MIT
#include "view/skeleton.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/kinematics.hpp"
#include "view/source.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

Skeleton skeleton_of(const std::string& name) {
  auto scene =
      std::make_shared<const Scene>(load_scene(std::filesystem::path(MIXLOOP_SCENES) / (name + ".yaml")));
  return Skeleton(scene, scene->default_parameters());
}

// By hand: at psi = 0 all of Appendix B's q's are q1 = q2 = q3 = 0, so link 2 lies along x at the height L1
// and the pantograph's first link too.
TEST(Skeleton, PlacesThePapersRobot) {
  Skeleton robot = skeleton_of("mixed_loop_robot");
  robot.place(std::vector<double>{0, 0, 0}, 0);
  ASSERT_EQ(robot.frames(), 7u);
  const auto place = [&](std::size_t i) { return Eigen::Vector3d(robot.frame(i).col(3)); };
  const double round_off = 1e-15;
  EXPECT_LT((place(1) - Eigen::Vector3d(0, 0, 0.3)).norm(), round_off);
  EXPECT_LT((place(2) - Eigen::Vector3d(0.3, 0, 0.3)).norm(), round_off);
  EXPECT_LT((place(4) - Eigen::Vector3d(0.15, 0, 0.3)).norm(), round_off);
  EXPECT_LT((place(3) - robot.end_effector()).norm(), round_off);  // E is frame 3's origin
}

// Links 4, 5, 6 and link 2's other side (26 cm at 57 degrees from the first) are a parallelogram: link 6 ends
// on body 2.
TEST(Skeleton, FindsWhereThePantographCloses) {
  Skeleton robot = skeleton_of("mixed_loop_robot");
  ASSERT_EQ(robot.closures().size(), 1u);
  EXPECT_EQ(robot.closures()[0].leaf, 6u);
  EXPECT_EQ(robot.closures()[0].on, 2u);
  robot.place(std::vector<double>{3, -200, 150}, 0);
  const Eigen::Vector3d end = robot.frame(6).col(3), shoulder = robot.frame(1).col(3),
                        elbow = robot.frame(2).col(3);
  EXPECT_NEAR((end - shoulder).norm(), 0.26, 1e-14);
  const double angle = std::acos((end - shoulder).dot(elbow - shoulder) / (0.26 * 0.3));
  EXPECT_NEAR(angle, 57 * std::numbers::pi / 180, 1e-13);  // round-off of angles of hundreds of degrees
}

// Link 2's two sides are drawn to the elbow, and to where link 6 ends on it.
TEST(Skeleton, HandsOverTheSolidsThatTheSceneNames) {
  Skeleton robot = skeleton_of("mixed_loop_robot");
  const auto solids = robot.description()["solids"];
  ASSERT_EQ(solids.size(), 8u);
  EXPECT_EQ(solids[2]["frame"], 2);
  EXPECT_EQ(solids[2]["shape"], "capsule");
  EXPECT_EQ(solids[2]["radius"], 0.02);
  EXPECT_EQ(solids[2]["from"], nlohmann::json({-0.3, 0, 0}));
  robot.place(std::vector<double>{3, -200, 150}, 0);
  const auto& to = solids[3]["to"];
  const Eigen::Vector3d end = at_point<double>(robot.frame(2), Eigen::Vector3d(to[0], to[1], to[2]));
  EXPECT_LT((end - Eigen::Vector3d(robot.frame(6).col(3))).norm(), 1e-14);
  EXPECT_TRUE(skeleton_of("double_four_bar").description()["solids"].empty());
}

TEST(Skeleton, ClosesEveryLoopOfTheScenes) {
  const Skeleton bars =
      skeleton_of("double_four_bar");  // all lying bars move in parallel; each ends on the next standing one
  ASSERT_EQ(bars.closures().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [leaf, on] = bars.closures()[i];
    EXPECT_EQ(bars.scene().frames[leaf], "lying " + std::to_string(i + 1));
    EXPECT_EQ(bars.scene().frames[on], "standing " + std::to_string(i + 2));
  }
  EXPECT_EQ(skeleton_of("spatial_slider_crank").closures().size(), 1u);
}

// Bars lie between frames that a person named; the joint of the rod is at one amid its pose.
TEST(Skeleton, TellsFramesAmidAPoseByTheirLackOfAName) {
  const auto scene = std::make_shared<const Scene>(load_scene(parse_document(R"(
motors: [a, b]
transforms:
  - {from: 0, to: arm, revolute: a}
  - {from: arm, to: rod, at: [1, 2, 0], revolute: b, axis: x}
  - {from: rod, to: tip, at: [0, 0, 1]}
bodies: [{frame: tip, mass: 1}]
end_effector: {frame: tip}
)",
                                                                             "posed")));
  const Skeleton posed(scene, {});
  EXPECT_TRUE(posed.closures().empty()) << "the rod's origin stands still in the frames amid its own pose";
  std::vector<std::string> names;
  std::size_t joints = 0;
  const auto description = posed.description();
  for (const auto& frame : description["frames"]) {
    names.push_back(frame["name"]);
    joints += frame.contains("coordinate");
  }
  EXPECT_THAT(names, ElementsAre("0", "arm", "", "", "", "rod", "tip"));
  EXPECT_EQ(joints, 2U);
  const std::size_t joint = description["motors"][1]["joint"];
  EXPECT_EQ(description["frames"][joint]["coordinate"], "b");
}

TEST(Skeleton, ShowsEachMotorsTorqueAtAJointThatItMoves) {
  const auto motors = skeleton_of("mixed_loop_robot").description()["motors"];
  std::vector<int> joints;
  for (const auto& motor : motors) joints.push_back(motor["joint"]);
  EXPECT_THAT(joints, ElementsAre(1, 2, 4));  // q1, q2, q3: the shoulder's three
}

// The crank's motor turns the crank, frame 4, one to one; the slider, nearer to the ground, by no constant
// ratio.
TEST(Skeleton, PrefersTheJointThatTurnsAsTheMotorDoes) {
  EXPECT_EQ(skeleton_of("spatial_slider_crank").description()["motors"][0]["joint"], 4);
}

TEST(Skeleton, SaysWhereTheFramesAreAtHome) {
  // Upright bars of 1 m on pivots 0, 1 and 2 m from the origin.
  const auto frames = skeleton_of("double_four_bar").description()["frames"];
  const Eigen::Vector3d top(frames.back()["home"][0], frames.back()["home"][1], frames.back()["home"][2]);
  EXPECT_LT((top - Eigen::Vector3d(2, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(frames[0]["home"], nlohmann::json({0, 0, 0}));
}

TEST(Skeleton, WritesAPoseThatReadsBackToTheSameNumbers) {
  Skeleton robot = skeleton_of("mixed_loop_robot");
  Pose pose{.k = 12, .t = 0.012, .session = std::int64_t{1} << 62};
  pose.psi = {0.1, -16.7, 1.0 / 3};
  pose.tau = {1, std::nan(""), -2};
  const auto json = nlohmann::json::parse(pose_json(robot, pose, ""));
  EXPECT_EQ(json["psi"].get<std::vector<double>>(), pose.psi);
  EXPECT_TRUE(json["tau"][1].is_null());
  EXPECT_TRUE(json["error"][0].is_null());
  EXPECT_EQ(json["session"], "4611686018427387904");
  EXPECT_EQ(json["frames"].size(), 7 * 7u);
  EXPECT_TRUE(json["traces"].is_null());
  pose.note = "a \"quoted\" note";
  EXPECT_EQ(nlohmann::json::parse(pose_json(robot, pose, ""))["note"], pose.note);
}

TEST(Skeleton, OfAMechanismWithoutAnEndEffectorDrawsNone) {
  const auto scene = std::make_shared<const Scene>(load_scene(parse_document(
      "motors: [psi]\ncoordinates: [q]\nconstraints: {q: psi}\n"
      "transforms: [{from: 0, to: bar, theta: q, a: 1 m}]\nbodies: [{frame: bar, mass: 1 kg}]\n",
      "bar.yaml")));
  Skeleton bar(scene, scene->default_parameters());
  const auto json = nlohmann::json::parse(pose_json(bar, {.k = 1, .psi = {0.5}, .tau = {0}}, ""));
  EXPECT_TRUE(json["E"][0].is_null());
  EXPECT_TRUE(json["error"][0].is_null());
  EXPECT_EQ(json["frames"].size(), 2 * 7u);
}

// There and back on a line of 1 m, and 1 m off it at the end: laps are drawn once, in no more points than
// asked for.
TEST(Path, LeavesOutWhereItWasBefore) {
  std::vector<Eigen::Vector3d> path = {Eigen::Vector3d::Constant(std::nan(""))};
  for (int lap = 0; lap < 3; ++lap) {
    for (int i = 0; i <= 1000; ++i) path.emplace_back(0.001 * i, 0, 0);
    for (int i = 1000; i >= 0; --i) path.emplace_back(0.001 * i, 0, 0);
  }
  path.emplace_back(0, 1, 0);
  const auto points = path_json(path, 100);
  ASSERT_LE(points.size(), 100u);
  ASSERT_GE(points.size(), 30u);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) EXPECT_GT(points[i][0], points[i - 1][0]) << i;
  EXPECT_EQ(points.front(), nlohmann::json({0, 0, 0}));
  EXPECT_EQ(points.back(), nlohmann::json({0, 1, 0}));
}

TEST(Path, MayStandStill) {
  EXPECT_EQ(path_json({Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()}),
            nlohmann::json::parse("[[1, 1, 1]]"));
  EXPECT_EQ(path_json({}), nlohmann::json::array());
}

}  // namespace
}  // namespace mixloop
