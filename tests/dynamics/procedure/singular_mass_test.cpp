// SPDX-License-Identifier: MIT
// Motions that no inertia resists are told from those that little does.
#include "dynamics/procedure/singular_mass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"

namespace mixloop {
namespace {

std::shared_ptr<const Scene> scene_of(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "scene.yaml")));
}

std::string refusal(const std::string& text) {
  const auto scene = scene_of(text);
  try {
    require_inertia(scene, scene->default_parameters());
  } catch (const InputError& error) {
    EXPECT_EQ(error.code, "singular_mass");
    return error.what();
  }
  return {};
}

/// A boom of 10 m and 1000 kg that carries a wrist; `wrist` are the numbers of its body.
std::string boom(const std::string& wrist) {
  return R"(
motors: [boom, wrist]
coordinates: [q1, q2]
constraints: {q1: boom, q2: wrist}
transforms:
  - {from: 0, to: 1, theta: q1, a: 10 m, alpha: 90 deg}
  - {from: 1, to: 2, theta: q2}
bodies:
  - {name: mast, frame: 1, mass: 1000 kg}
  - {name: tool, frame: 2, )" +
         wrist + R"(}
end_effector: {frame: 2}
)";
}

TEST(SingularMass, IsThatOfAPointMassOnItsAxis) {
  const std::string said = refusal(boom("mass: 3 kg, center_of_mass: [0, 0, -0.026]"));
  EXPECT_NE(said.find("motor 'wrist' moves no inertia"), std::string::npos) << said;
  EXPECT_NE(said.find("'tool'"), std::string::npos) << said;
  EXPECT_EQ(said.find("'mast'"), std::string::npos) << said;
}

// 1e-12 kg m^2 beside 1e5: a watch's wheel on a crane.
TEST(SingularMass, IsNotThatOfALittleInertia) {
  EXPECT_EQ(refusal(boom("mass: 3 kg, inertia: {xx: 1e-12, yy: 1e-12, zz: 1e-12}")), "");
  EXPECT_EQ(refusal(boom("mass: 1e-6 kg, center_of_mass: [1 um, 0, 0]")), "");
}

TEST(SingularMass, NamesWhatNothingHangsOn) {
  const std::string said = refusal(R"(
motors: [a, idle]
coordinates: [q1, q2]
constraints: {q1: a, q2: idle}
transforms:
  - {from: 0, to: 1, theta: q1, a: 1 m}
  - {from: 0, to: 2, theta: q2, a: 1 m}
bodies: [{frame: 1, mass: 1 kg}]
end_effector: {frame: 1}
)");
  EXPECT_NE(said.find("no body hangs on motor 'idle'"), std::string::npos) << said;
}

// Both motors turn the one joint: turned against each other they move nothing.
TEST(SingularMass, NamesMotorsThatMoveNothingTogether) {
  const std::string said = refusal(R"(
motors: [a, b]
coordinates: [q]
constraints: {q: a + 1e-6 * b}
transforms: [{from: 0, to: 1, theta: q, a: 1 m}]
bodies: [{frame: 1, mass: 1 kg}]
end_effector: {frame: 1}
)");
  EXPECT_NE(said.find("motors 'a' and 'b' can move together"), std::string::npos) << said;
}

// The load's arm about the first axis vanishes only where it is stretched along it.
TEST(SingularMass, OfOnePoseIsToldThereAndNotAtLoad) {
  const std::string text = R"(
motors: [turn, lift]
coordinates: [q1, q2]
constraints: {q1: turn, q2: lift}
transforms:
  - {from: 0, to: 1, theta: q1, alpha: 90 deg}
  - {from: 1, to: 2, theta: q2, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2}
home: {lift: 90 deg}
)";
  EXPECT_EQ(refusal(text), "");
  const auto scene = scene_of(text);
  const std::vector<double> parameters;
  const auto model = make_model<double>(scene, std::span<const double>(parameters));
  const std::vector<double> level = {0, 0.3}, up = {0, std::numbers::pi / 2};
  EXPECT_FALSE(why_mass_is_singular(model, level, 0));
  ASSERT_TRUE(why_mass_is_singular(model, up, 0));
  EXPECT_NE(why_mass_is_singular(model, up, 0)->find("'turn'"), std::string::npos);
}

// A ratio of 1e6 between motors, each well: M's elements differ by 1e12.
TEST(SingularMass, KnowsUnlikeUnits) {
  EXPECT_EQ(refusal(R"(
motors: {a: rotary, b: linear}
coordinates: [q, x]
constraints: {q: a / 1e6, x: b}
transforms:
  - {from: 0, to: 1, theta: q, alpha: 90 deg}
  - {from: 1, to: 2, s: x, a: 1 m}
bodies: [{frame: 2, mass: 1 kg}]
end_effector: {frame: 2}
)"),
            "");
}

}  // namespace
}  // namespace mixloop
