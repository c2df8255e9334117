// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "planner/hand_kinematics.hpp"

namespace mixloop {

/// What a path prescribes of the end effector, as equations for the motors that may move: its place on the
/// scene's axes; then how it is turned, or where it points, where an angle counts as a length by the
/// mechanism's scale.
class Prescription {
 public:
  /// `held`: motors that stay at home. Throws InputError("other_turns") where the end effector turns about
  /// other axes than the one that the scene names. Refers to `hand`.
  Prescription(HandKinematics& hand, const std::vector<int>& held);

  Eigen::Index rows() const { return rows_; }
  /// How many motors may move.
  Eigen::Index active() const { return static_cast<Eigen::Index>(active_.size()); }
  /// "3 numbers of the end effector (x, y, z)".
  std::string text() const;

  /// What a pose lacks. Of one evaluation: where closures are solved the next starts from its solution, and
  /// bits are a matter of how often that was.
  struct Miss {
    Vector error;      ///< rows, m: the length of `jacobian` times the move that is missing
    Matrix jacobian;   ///< rows x active
    Vector rate;       ///< rows, m/s: what psid has to bring the end effector
    double place = 0;  ///< of the place alone, m
    double angle = 0;  ///< of the turn alone, rad
  };
  Miss miss(const PathPoint& point, double t, const Vector& psi);
  /// Its Jacobian alone: rows x active, m, an own direction's rows across it.
  Matrix jacobian(double t, const Vector& psi);
  /// "it can't move along (0, 0, 1)": of a move that no motors make, rows.
  std::string text_of_lost(double t, const Vector& psi, const Vector& move);
  /// What psidd has to bring beside psid: rows, m/s^2.
  Vector acceleration_to(const PathPoint& point, double t, const Vector& psi, const Vector& psid);
  /// d/dt (jacobian^T) lambda along psid, for `lambda` (rows), whose rows turn with the direction: active.
  Vector turning_back(const PathPoint& point, double t, const Vector& psi, const Vector& psid,
                      const Vector& lambda);

  /// Of all motors: those that are held don't move.
  Vector on_all(const Vector& active) const;
  Vector on_active(const Vector& all) const;

 private:
  Matrix turning_rows(const Eigen::Matrix3d& rotation) const;
  void require_turns_about(int axis);

  HandKinematics& hand_;
  const Scene::EndEffector& end_effector_;
  std::vector<int> active_;
  Eigen::Index rows_ = 0, turning_ = 0;
};

}  // namespace mixloop
