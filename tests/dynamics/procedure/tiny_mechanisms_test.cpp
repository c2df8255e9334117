// SPDX-License-Identifier: MIT
// Mechanisms so small that their answers are whole numbers, worked out by hand in the comments. g = 10.
#include <gtest/gtest.h>

#include "tests/dynamics/procedure/scene_procedure.hpp"

namespace mixloop {
namespace {

using Vector1 = Eigen::Matrix<double, 1, 1>;
using Vector2 = Eigen::Vector2d;

Procedure<double> mechanism(const char* text) {
  return Procedure<double>(load_scene(parse_document(text, "tiny.yaml")));
}

Vector1 one(double x) { return Vector1(x); }

// A 2 kg point on 3 m of massless rod, angle from the horizontal: M = m l^2 = 18, h = m g l cos(psi) = 60.
TEST(TinyMechanisms, Pendulum) {
  auto pendulum = mechanism(R"(
motors: [psi]
coordinates: [q]
constraints: {q: psi}
transforms: [{from: 0, to: rod, theta: q, a: 3 m}]
bodies: [{frame: rod, mass: 2 kg}]
gravity: [0, -10 m/s^2, 0]
end_effector: {frame: rod, axes: [y]}
)");
  EXPECT_DOUBLE_EQ(pendulum.mass(one(0))(0, 0), 18);
  EXPECT_DOUBLE_EQ(pendulum.h(one(0), one(7))[0], 60);  // no rate in it
  EXPECT_DOUBLE_EQ(pendulum.forward(one(0), one(7), one(60))[0], 0);
  EXPECT_DOUBLE_EQ(pendulum.forward(one(0), one(7), one(6))[0], -3);
  const auto end = pendulum.end(one(0), one(2), one(5));
  EXPECT_DOUBLE_EQ(end.velocity[1], 6);        // l psi'
  EXPECT_DOUBLE_EQ(end.acceleration[0], -12);  // -l psi'^2
  EXPECT_DOUBLE_EQ(end.acceleration[1], 15);   // l psi''
  EXPECT_DOUBLE_EQ(pendulum.energies(one(0), one(2)).kinetic, 36);
}

// Cart of 3 kg along x, a 1 kg point 2 m under it, angle from hanging towards -x. Hanging: M = [4, -2; -2,
// 4]. With the rod level, towards +x (-90 deg): M = [4, 0; 0, 4], h = (-m l psi'^2, -m g l) = (-18, -20) at 3
// rad/s.
TEST(TinyMechanisms, CartPole) {
  auto cart_pole = mechanism(R"(
motors: {x: linear, angle: rotary}
coordinates: [slide, swing]
constraints: {slide: x, swing: angle}
transforms:
  - {from: 0, to: rail, theta: 90 deg, alpha: 90 deg}    # z along X, x along Y, y along Z
  - {from: rail, to: cart, s: slide, alpha: 90 deg}      # z along -Z, x along Y, y along X
  - {from: cart, to: pivot, theta: 90 deg, alpha: 90 deg}  # z along Y, x along X, y along -Z
  - {from: pivot, to: pole, theta: swing + 90 deg, a: 2 m}
bodies:
  - {frame: cart, mass: 3 kg}
  - {frame: pole, mass: 1 kg}
gravity: [0, 0, -10 m/s^2]
end_effector: {frame: pole, axes: [x, z]}
)");
  const double right_angle = std::acos(0.0);
  const Vector2 hanging(0, 0), level(0, -right_angle);
  EXPECT_NEAR(cart_pole.end(hanging, hanging, hanging).position[2], -2, 1e-15);
  EXPECT_NEAR(cart_pole.end(level, hanging, hanging).position[0], 2, 1e-15);
  const auto M = cart_pole.mass(hanging);
  EXPECT_NEAR(M(0, 0), 4, 1e-14);
  EXPECT_NEAR(M(0, 1), -2, 1e-14);
  EXPECT_NEAR(M(1, 1), 4, 1e-14);
  const auto h = cart_pole.h(level, Vector2(0, 3));
  EXPECT_NEAR(h[0], -18, 1e-13);
  EXPECT_NEAR(h[1], -20, 1e-13);
  // Level and let go: the point falls at 5 rad/s^2 = g / l, the cart stays.
  const auto psidd = cart_pole.forward(level, Vector2(0, 0), Vector2(0, 0));
  EXPECT_NEAR(psidd[0], 0, 1e-14);
  EXPECT_NEAR(psidd[1], 5, 1e-14);
}

// A motor with inertia 1 turns a wheel of inertia 9 through q2 = psi / 3: M = 1 + 9 / 9 = 2.
TEST(TinyMechanisms, GearPair) {
  auto gears = mechanism(R"(
motors: [psi]
coordinates: [q1, q2]
constraints: {q1: psi, q2: psi / 3}
transforms:
  - {from: 0, to: rotor, theta: q1}
  - {from: 0, to: wheel, theta: q2}
bodies:
  - {frame: rotor, mass: 0, inertia: {xx: 1, yy: 1, zz: 1 kg m^2}}
  - {frame: wheel, mass: 4 kg, inertia: {xx: 9, yy: 9, zz: 9 kg m^2}}
gravity: [0, 0, -10]
end_effector: {frame: wheel, axes: [x]}
)");
  EXPECT_DOUBLE_EQ(gears.mass(one(5))(0, 0), 2);
  EXPECT_DOUBLE_EQ(gears.h(one(5), one(4))[0], 0);
  EXPECT_DOUBLE_EQ(gears.forward(one(5), one(4), one(6))[0], 3);
}

// A 5 kg slider lifted along z by a screw of 2 m a radian: M = 5 * 4 = 20, h = m g 2 = 100.
TEST(TinyMechanisms, Slider) {
  auto slider = mechanism(R"(
motors: [psi]
coordinates: [lift]
constraints: {lift: 2 m * psi}
transforms: [{from: 0, to: slider, s: lift}]
bodies: [{frame: slider, mass: 5 kg}]
gravity: [0, 0, -10 m/s^2]
end_effector: {frame: slider, axes: [z]}
)");
  EXPECT_DOUBLE_EQ(slider.mass(one(0))(0, 0), 20);
  EXPECT_DOUBLE_EQ(slider.h(one(0), one(3))[0], 100);
  EXPECT_DOUBLE_EQ(slider.forward(one(0), one(3), one(140))[0], 2);
  EXPECT_DOUBLE_EQ(slider.energies(one(3), one(1)).potential, 300);
}

// A slider that a clock drives: lift = psi t + t^2, so lift'' = psi'' t + 2 psi' + 2. At t = 3 with m = 1,
// no gravity: M = t^2 = 9, h = t (2 psi' + 2) = 3 (2 * 4 + 2) = 30. Half of it is the mixed term.
TEST(TinyMechanisms, ClockDrivenSlider) {
  auto driven = mechanism(R"(
motors: [psi]
coordinates: [lift]
constraints: {lift: (psi * t / (1 s) + (t / (1 s))^2) * (1 m)}
transforms: [{from: 0, to: slider, s: lift}]
bodies: [{frame: slider, mass: 1 kg}]
gravity: [0, 0, 0]
end_effector: {frame: slider, axes: [z]}
)");
  EXPECT_DOUBLE_EQ(driven.mass(one(7), 3)(0, 0), 9);
  EXPECT_DOUBLE_EQ(driven.h(one(7), one(4), 3)[0], 30);
  EXPECT_DOUBLE_EQ(driven.end(one(7), one(4), one(0), 3).velocity[2], 4 * 3 + 7 + 6);
}

// A force of 6 N across a 3 m arm and a moment of 2 N m about it: h = -(18 + 2).
TEST(TinyMechanisms, LoadsActThroughTheirPoints) {
  auto arm = mechanism(R"(
motors: [psi]
coordinates: [q]
constraints: {q: psi}
transforms: [{from: 0, to: arm, theta: q, a: 1 m}]
bodies: [{frame: arm, mass: 1 kg}]
loads: [{frame: arm, point: [2 m, 0, 0], force: [5 N, 6 N, 7 N], moment: [3 N m, 4 N m, 2 N m]}]
gravity: [0, 0, -10 m/s^2]
end_effector: {frame: arm, axes: [y]}
)");
  EXPECT_DOUBLE_EQ(arm.h(one(0), one(0))[0], -20);
  EXPECT_DOUBLE_EQ(arm.forward(one(0), one(0), one(0))[0], 20);
}

// A spring of 8 N m/rad, 2 rad from its rest, and friction of 3 N m s/rad at 5 rad/s, behind a gear of 1/2:
// h = (8 * 2 + 3 * 5) / 2; the spring holds 8 * 2^2 / 2 J.
TEST(TinyMechanisms, SpringsAndFrictionActOnTheirCoordinates) {
  auto arm = mechanism(R"(
motors: [psi]
coordinates: [q]
constraints: {q: psi / 2}
transforms: [{from: 0, to: arm, theta: q, a: 1 m}]
bodies: [{frame: arm, mass: 4 kg}]
loads: [{coordinate: q, stiffness: 8 N m/rad, rest: 1 rad, damping: 3 N m s/rad}]
end_effector: {frame: arm, axes: [y]}
)");
  EXPECT_DOUBLE_EQ(arm.h(one(6), one(10))[0], 15.5);
  EXPECT_DOUBLE_EQ(arm.forward(one(6), one(10), one(0))[0], -15.5);
  EXPECT_DOUBLE_EQ(arm.energies(one(6), one(0)).potential, 16);
}

// The same of a displacement: 8 N/m, 2 m from its rest, 3 N s/m at 5 m/s.
TEST(TinyMechanisms, SpringsActOnDisplacements) {
  auto slider = mechanism(R"(
motors: {psi: linear}
coordinates: [lift]
constraints: {lift: psi}
transforms: [{from: 0, to: slider, s: lift}]
bodies: [{frame: slider, mass: 1 kg}]
loads: [{coordinate: lift, stiffness: 8 N/m, rest: 1 m, damping: 3 N s/m}]
end_effector: {frame: slider, axes: [z]}
)");
  EXPECT_DOUBLE_EQ(slider.h(one(3), one(5))[0], 31);
}

}  // namespace
}  // namespace mixloop
