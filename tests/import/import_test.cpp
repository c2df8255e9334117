// SPDX-License-Identifier: MIT
#include "import/import_urdf.hpp"

#include <gmock/gmock.h>

#include <random>

#include "dynamics/assembly/load_scene.hpp"
#include "import/yaml_text.hpp"
#include "notation/value.hpp"
#include "tests/import/robots.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

/// What of a robot isn't carried over, a line a kind.
std::string left_of(const Imported& made) {
  std::string all;
  for (const auto& kind : made.left.kinds()) all += text_of(kind) + "\n";
  return all;
}

/// The scene without the comments that it begins with.
std::string without_head(const std::string& text) { return text.substr(text.find("\nname: ") + 1); }

TEST(ImportUrdf, ACartPoleReadsAsOneWouldWriteIt) {
  ImportOptions options;
  options.free = {"pole"};
  EXPECT_EQ(imported_robot("cart_pole", options).scene,
            R"(# cart_pole, imported from cart_pole.urdf by `mixloop import`.
# Frame 0 is the link rail; the end effector is the origin of pole_tip.

name: cart_pole

motors: {cart: linear}
free: [pole]

transforms:
  - {from: 0, to: cart_body, prismatic: cart, axis: x}
  - {from: cart_body, to: pole_body, revolute: pole, axis: [0, -1, 0]}
  - {from: pole_body, to: pole_tip, at: [0, 0, 0.6 m]}

bodies:
  - {name: cart_body, frame: cart_body, mass: 0.5 kg,
     inertia: {xx: 0.0005 kg m^2, yy: 0.0018 kg m^2, zz: 0.002 kg m^2}}
  - {name: pole_body, frame: pole_body, mass: 0.2 kg,
     center_of_mass: [0, 0, 0.3 m],
     inertia: {xx: 0.006 kg m^2, yy: 0.006 kg m^2, zz: 1e-05 kg m^2}}

loads:
  - {along: cart, damping: 0.1 N s/m}

gravity: [0, 0, -9.81 m/s^2]
end_effector: {frame: pole_tip, axes: [x]}

solids:
  - {frame: 0, shape: cylinder, radius: 0.005 m, from: [-1 m, 0, 0], to: [1 m, 0, 0]}
  - {frame: cart_body, shape: box, size: [0.2 m, 0.1 m, 0.06 m]}
  - {frame: pole_body, shape: cylinder, radius: 0.01 m, from: [0, 0, 0], to: [0, 0, 0.6 m]}
)");
}

TEST(ImportUrdf, TheShippedUr5IsWhatIsMadeOfItsUrdf) {
  EXPECT_EQ(without_head(bytes_of(MIXLOOP_SCENES "/ur5.yaml")), without_head(imported_robot("ur5").scene));
}

class EachRobot : public testing::TestWithParam<const char*> {};

TEST_P(EachRobot, IsASceneOfItsJoints) {
  const Imported made = imported_robot(GetParam());
  const Scene scene = load_scene(parse_document(made.scene, "scene"));
  EXPECT_EQ(scene.name, GetParam());
  ASSERT_EQ(scene.motors().size(), made.motors.size());
  for (std::size_t i = 0; i < made.motors.size(); ++i) EXPECT_EQ(scene.motors()[i].name, made.motors[i]);
  EXPECT_TRUE(scene.end_effector.named);
}

INSTANTIATE_TEST_SUITE_P(Robots, EachRobot, testing::ValuesIn(kRobots),
                         [](const auto& robot) { return std::string(robot.param); });

TEST(ImportUrdf, JointsThatMimicFollowByConstraints) {
  const Imported made = imported_robot("gripper");
  EXPECT_THAT(made.motors, ElementsAre("left_knuckle_joint"));
  EXPECT_THAT(made.scene,
              HasSubstr("coordinates: [left_finger_joint, right_knuckle_joint, right_finger_joint, s_joint]\n"
                        "constraints:\n"
                        "  left_finger_joint: -left_knuckle_joint - 0.05 rad\n"
                        "  right_knuckle_joint: -left_knuckle_joint\n"
                        "  right_finger_joint: -right_knuckle_joint + 0.05 rad\n"
                        "  s_joint: 0.025 m * left_knuckle_joint + 0.001 m\n"));
  EXPECT_THAT(made.scene, HasSubstr("# Renamed: s is s_joint.\n"));
  EXPECT_THAT(made.renamed, testing::Contains(Pair("left-knuckle joint", "left_knuckle_joint")));
  EXPECT_THAT(made.scene,
              HasSubstr("{from: \"left knuckle\", to: \"left finger\", at: [0, 0.04 m, 0.06 m], revolute: "
                        "left_finger_joint, axis: x}"));
}

TEST(ImportUrdf, ABoxThatIsTurnedHasAFrameOfItsOwn) {
  const std::string scene = imported_robot("gripper").scene;
  EXPECT_THAT(scene, HasSubstr("{from: \"left knuckle\", to: \"left knuckle/box_1\", at: [0, 0.02 m, 0.03 "
                               "m], rpy: [0.5 rad, 0, 0]}"));
  EXPECT_THAT(scene,
              HasSubstr("{frame: \"left knuckle/box_1\", shape: box, size: [0.02 m, 0.01 m, 0.07 m]}"));
}

TEST(ImportUrdf, InertiasAreTurnedIntoTheLinksAxes) {
  // PUMA's link 2 has its frame's axes; link 4's are turned by 90 degrees about x: yy and zz change places.
  const std::string scene = imported_robot("puma_560").scene;
  EXPECT_THAT(scene, HasSubstr("inertia: {xx: 0.13 kg m^2, yy: 0.524 kg m^2, zz: 0.539 kg m^2}"));
  EXPECT_THAT(scene, HasSubstr("inertia: {xx: 0.0018 kg m^2, yy: 0.0018 kg m^2, zz: 0.0013 kg m^2}"));
}

TEST(ImportUrdf, WhatIsNotCarriedOverIsListed) {
  EXPECT_EQ(left_of(imported_robot("double_pendulum")), "");
  EXPECT_THAT(
      left_of(imported_robot("iiwa7")),
      testing::AllOf(HasSubstr("inertias of links that stand still: iiwa_link_0\n"),
                     HasSubstr("meshes of the links: iiwa_link_0, iiwa_link_1,"),
                     HasSubstr("collision meshes of the links: iiwa_link_1,"),
                     HasSubstr("<material>: Orange\n"), HasSubstr("<self_collision_checking>: iiwa_link_0\n"),
                     HasSubstr("<safety_controller>: iiwa_joint_1, iiwa_joint_2,"),
                     HasSubstr("<transmission>: iiwa_tran_1, iiwa_tran_2,"),
                     HasSubstr("<gazebo>: iiwa_link_1\n")));
  EXPECT_THAT(
      left_of(imported_robot("mini_cheetah_leg")),
      testing::AllOf(
          HasSubstr("floating joints, held fixed: base_floats\n"),
          HasSubstr(
              "Coulomb friction of the joints (plant.actuators has one for motors): ab_ad, hip, knee")));
  EXPECT_THAT(left_of(imported_robot("puma_560")),
              HasSubstr("inertias that no real mass has, taken as they are, of the links: link3\n"));
  EXPECT_THAT(left_of(imported_robot("irb_120")),
              HasSubstr("limits of effort of 0, of the joints: joint_1, joint_2,"));
  EXPECT_THAT(imported_robot("iiwa7").scene,
              HasSubstr("# Not carried over:\n# - inertias of links that stand still: iiwa_link_0\n"));
}

TEST(ImportUrdf, CollisionShapesAreDrawnWhereThereIsNoVisualOne) {
  EXPECT_THAT(imported_robot("baxter_arm").scene,
              HasSubstr("{frame: right_upper_shoulder, shape: cylinder, radius: 0.06 m, from: [0, 0, 0], to: "
                        "[0, 0, 0.2722 m]}"));
}

TEST(ImportUrdf, TheTipIsTheLeafThatMostJointsMoveUnlessToldOtherwise) {
  EXPECT_EQ(imported_robot("panda").tip, "panda_leftfinger");
  ImportOptions options;
  options.tip = "panda_hand_tcp";
  EXPECT_EQ(imported_robot("panda", options).tip, "panda_hand_tcp");
}

TEST(ImportUrdf, PathsAreOfferedTheAxesThatMotorsCanMoveAlong) {
  EXPECT_THAT(imported_robot("double_pendulum").scene, HasSubstr("axes: [x, z]}"));
  EXPECT_THAT(imported_robot("ur5").scene, HasSubstr("axes: [x, y, z]}"));
}

TEST(ImportUrdf, HomeIsWithinTheLimits) {
  EXPECT_THAT(imported_robot("panda").scene, HasSubstr("home: {panda_joint4: -1.571 rad}\n"));
  EXPECT_THAT(imported_robot("mini_cheetah_leg").scene, HasSubstr("home: {knee: -1.5 rad}\n"));
}

TEST(ImportUrdf, NumbersAndAnglesReadBackAsTheSameDoubles) {
  std::mt19937 chance(1);
  std::uniform_real_distribution<double> any(-10, 10);
  const auto read = [](const std::string& text, const Dimension& dimension) {
    return number_of(*parse_document(text, "number"), dimension, "it");
  };
  for (int i = 0; i < 1000; ++i) {
    const double value = any(chance) * std::pow(10.0, i % 20 - 10);
    EXPECT_EQ(read(quantity(value, "m"), kLength), value);
    EXPECT_EQ(read(angle_text(value), kPure), value) << angle_text(value);
  }
  for (int degrees = -720; degrees <= 720; ++degrees) {
    const double value = degrees * (std::numbers::pi / 360);
    EXPECT_EQ(read(angle_text(value), kPure), value) << angle_text(value);
  }
  EXPECT_EQ(angle_text(std::numbers::pi / 2), "90 deg");
  EXPECT_EQ(angle_text(-std::numbers::pi), "-180 deg");
  EXPECT_EQ(angle_text(1.5708), "1.5708 rad");
}

}  // namespace
}  // namespace mixloop
