// SPDX-License-Identifier: MIT
// The paper's robot as the peers' general engines take it: an open tree of six revolute joints (joint i
// turns q_i about the z axis where it stands; then Tz(s) Tx(a) Rx(alpha) leads to link i's frame), and
// Q = C psi + offset. Joints in the order q1, q2, q5, q3, q6, q4 of Table B-1.
#pragma once

#include <array>

namespace mixloop::bench {

struct TreeJoint {
  int parent;  ///< -1: the ground
  double s, a, alpha;
  double mass;
  std::array<double, 3> centre, inertia;  ///< in the link's frame, about the centre
};

inline constexpr int kJoints = 6;
inline constexpr int kEndEffectorJoint = 2;            ///< E is the origin of its link's frame
inline constexpr double kPi = 3.14159265358979323846;  // C++17 here, for a peer's headers
inline constexpr double kRightAngle = kPi / 2;

inline constexpr std::array<TreeJoint, kJoints> kTree = {{
    {-1, 0.30, 0.00, kRightAngle, 2.00, {0, -0.15, 0}, {0.044, 0.008, 0.044}},
    {0, 0.00, 0.30, 0, 3.11, {-0.125, -0.043, 0}, {0.003, 0.013, 0.016}},
    {1, 0.00, 0.30, kRightAngle, 0.22, {-0.188, 0, 0}, {0.004, 0.02, 0.02}},
    {0, 0.00, 0.15, 0, 0.15, {-0.10, 0, 0}, {0.01, 0.015, 0.02}},
    {3, 0.00, 0.26, 0, 0.06, {-0.13, 0, 0}, {0, 0.004, 0.004}},
    {4, 0.00, 0.15, 0, 0.15, {-0.05, 0, 0}, {0.01, 0.015, 0.02}},
}};

/// Rows q1, q2, q5, q3, q6, q4: (B-1) to (B-6).
inline constexpr double kSun = 1.5 / 64;
inline constexpr std::array<std::array<double, 3>, kJoints> kCoupling = {{
    {1.0 / 8, 0, 0},
    {kSun, -1.0 / 16, 0},
    {0, -1.0 / 8, 1.0 / 8},
    {kSun, 0, -1.0 / 16},
    {0, -1.0 / 16, 1.0 / 16},
    {0, 1.0 / 16, -1.0 / 16},
}};

constexpr double radians(double degrees) { return degrees * kPi / 180; }
inline constexpr std::array<double, kJoints> kCouplingOffset = {
    0, 0, radians(46 - 2 * (180 + 57 - 115)), 0, radians(-57), radians(180 + 57)};

/// Torques on q1, q2 and q3 that do the work of the motors': with these three as the independent
/// coordinates q1 = psi1/8, q2 = 1.5/64 psi1 - psi2/16, q3 = 1.5/64 psi1 - psi3/16.
constexpr std::array<double, 3> basis_torque(const std::array<double, 3>& tau) {
  return {8 * tau[0] + 3 * (tau[1] + tau[2]), -16 * tau[1], -16 * tau[2]};
}
constexpr std::array<double, 3> motor_acceleration(double q1, double q2, double q3) {
  return {8 * q1, 3 * q1 - 16 * q2, 3 * q1 - 16 * q3};
}

}  // namespace mixloop::bench
