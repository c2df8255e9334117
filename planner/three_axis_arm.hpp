// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <optional>

#include "dynamics/procedure/model.hpp"

namespace mixloop {

/// An end effector behind three revolute axes, the first along Z0, the others parallel to each other and
/// perpendicular to it (base, shoulder, elbow), turned by three motors in any affine mixture: the family of
/// the paper's robot, whose inverse kinematics has a closed form.
struct ThreeAxisArm {
  double height = 0;   ///< of the shoulder axis over the origin, m
  double side = 1;     ///< +1 or -1: which way the shoulder axis lies, sin(alpha) of the base
  double base = 0;     ///< from the base axis to the shoulder axis, along the arm, m
  double lateral = 0;  ///< from the base axis to the arm's plane, along the shoulder axis, m
  double upper = 0;    ///< shoulder axis to elbow axis, m, positive
  double fore = 0;     ///< elbow axis to end effector, in the arm's plane, m, positive
  double front = 1;    ///< branch: +1, wrist in front of the base axis; -1, behind
  double elbow = 1;    ///< branch: sign of the sine of the elbow's angle

  Eigen::Matrix3d B, B_inverse;  ///< angles of base, shoulder and elbow axis = B psi + offset; at an elbow
  Eigen::Vector3d offset;        ///< angle of 0 the arm is stretched

  Eigen::Vector3d angles(const Eigen::Vector3d& psi) const { return B * psi + offset; }
  Eigen::Vector3d motors(const Eigen::Vector3d& angles) const { return B_inverse * (angles - offset); }

  /// The shoulder, m: where the reach is counted from.
  double nearest() const { return std::abs(upper - fore); }
  double farthest() const { return upper + fore; }
};

/// The arm, with its branch at the scene's home, when the model's end effector has that form and its three
/// coordinates are affine in the three motors, invertibly and independent of time.
std::optional<ThreeAxisArm> find_three_axis_arm(const Model<double>& model);

/// A point in the arm's own terms.
struct ArmReach {
  double beside =
      0;  ///< squared distance from the base axis beyond the arm's plane's; below 0: none reaches it
  double distance = 0;  ///< from the shoulder axis, in the arm's plane; from nearest() to farthest()
};
ArmReach reach_of(const ThreeAxisArm& arm, const Eigen::Vector3d& point);

/// The angles that bring the end effector to a point (x, y, z) on the arm's branch, each up to whole turns;
/// not finite where the point is out of reach. T: double, or a Taylor series for the rates as well.
template <class T>
std::array<T, 3> arm_angles(const ThreeAxisArm& arm, const std::array<T, 3>& p) {
  using mixloop_functions::atan2, mixloop_functions::cos, mixloop_functions::sin, std::sqrt;
  const auto number = [](double value) { return T(value); };
  // In the arm's plane: (base + X) along it, Y up from the shoulder.
  const T radial = number(arm.front) * sqrt(p[0] * p[0] + p[1] * p[1] - number(arm.lateral * arm.lateral));
  const T X = radial - number(arm.base);
  const T Y = number(arm.side) * (p[2] - number(arm.height));
  const T base = atan2(p[1], p[0]) - atan2(number(-arm.side * arm.lateral), radial);
  // Law of cosines by the half angle, exact also near the flat elbow.
  const T R = sqrt(X * X + Y * Y);
  const T open = (number(arm.farthest()) - R) * (number(arm.farthest()) + R);
  const T closed = (R - number(arm.nearest())) * (R + number(arm.nearest()));
  const T elbow = number(2 * arm.elbow) * atan2(sqrt(open), sqrt(closed));
  const T shoulder =
      atan2(Y, X) - atan2(number(arm.fore) * sin(elbow), number(arm.upper) + number(arm.fore) * cos(elbow));
  return {base, shoulder, elbow};
}

}  // namespace mixloop
