// SPDX-License-Identifier: MIT
#include "planner/orientation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {
namespace {

constexpr double kHalfTurn = std::numbers::pi * (1 - 1e-6);

Eigen::Matrix3d turn_about(int axis, double angle) {
  const double c = mixloop_functions::cos(angle), s = mixloop_functions::sin(angle);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(i, i) = turn(j, j) = c;
  turn(j, i) = s;
  turn(i, j) = -s;
  return turn;
}

Eigen::Matrix3d rotation_at(const Path::Via& via, const Eigen::Matrix3d& before, const Eigen::Matrix3d& home,
                            const Scene::EndEffector& end_effector) {
  if (end_effector.turns.size() == 3) return rotation_of(via.turns);
  if (end_effector.turns.size() == 1) return turn_about(end_effector.turns.front(), via.turns[0]) * home;
  if (!via.direction) return before;
  return shortest_turn(before * axis_of(end_effector), *via.direction) * before;
}

}  // namespace

Eigen::Vector3d axis_of(const Scene::EndEffector& end_effector) {
  const auto& axis = *end_effector.direction;
  return {axis[0], axis[1], axis[2]};
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& roll_pitch_yaw) {
  return turn_about(2, roll_pitch_yaw[2]) * turn_about(1, roll_pitch_yaw[1]) *
         turn_about(0, roll_pitch_yaw[0]);
}

Eigen::Matrix3d shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = from.cross(to);
  const double cosine = from.dot(to), sine = axis.norm();
  if (!(sine > 0))
    return cosine > 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                      : Eigen::AngleAxisd(std::numbers::pi, from.unitOrthogonal()).toRotationMatrix();
  const Eigen::Matrix3d skew = detail::skew_of_vector<double>(axis);
  return Eigen::Matrix3d::Identity() + skew + skew * skew * ((1 - cosine) / (sine * sine));
}

// Rodrigues' formula.
Eigen::Matrix3d turn_by(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d skew = detail::skew_of_vector<double>(rotation_vector / angle);
  const double half = mixloop_functions::sin(angle / 2);
  return Eigen::Matrix3d::Identity() + mixloop_functions::sin(angle) * skew + 2 * half * half * skew * skew;
}

// By the quaternion, whose sign is chosen so that the angle is the smaller one.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& turn) {
  Eigen::Quaterniond q(turn);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (!(sine > 0)) return Eigen::Vector3d::Zero();
  return q.vec() * (2 * mixloop_functions::atan2(sine, q.w()) / sine);
}

Path oriented(Path path, HandKinematics& hand) {
  const Scene::EndEffector& end_effector = hand.model().scene->end_effector;
  if (!end_effector.is_oriented() || path.is_of_motors()) return path;
  const Eigen::Matrix3d home = hand.turns_at(hand.home(), hand.rest(), hand.rest(), 0).rotation;
  const Eigen::Matrix3d* before = &home;
  for (Path::Via& via : path.vias) {
    via.rotation = rotation_at(via, *before, home, end_effector);
    if (before != &home && rotation_vector(via.rotation * before->transpose()).norm() > kHalfTurn)
      throw InputError(
          "out_of_range", via.place,
          "the end effector is to turn by half a turn on the line that leads here, and may do so either "
          "way round; expected a via point between");
    before = &via.rotation;
  }
  return path;
}

}  // namespace mixloop
