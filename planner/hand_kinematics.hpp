// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/procedure.hpp"
#include "planner/motion.hpp"

namespace mixloop {

/// How the end effector's frame is turned, in inertial axes.
struct HandTurns {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();       ///< angular velocity, rad/s
  Eigen::Vector3d spin_rate = Eigen::Vector3d::Zero();  ///< angular acceleration, rad/s^2
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian;    ///< 3 x n_u: d spin / d psid
};

/// Where the motors bring a scene's end effector while free coordinates rest at home, and what is long and
/// what is far for them.
class HandKinematics {
 public:
  /// Refers to `model`.
  explicit HandKinematics(const Model<double>& model);

  /// For given motors (n_u each), in a workspace that the next call overwrites.
  const EndEffectorState<double>& at(const Vector& psi, const Vector& psid, const Vector& psidd, double t);
  /// How its frame is turned and turns there: of the last `at`.
  HandTurns turns();
  HandTurns turns_at(const Vector& psi, const Vector& psid, const Vector& psidd, double t) {
    at(psi, psid, psidd, t);
    return turns();
  }

  const Model<double>& model() const { return model_; }
  /// The motors at home, n_u, and as many zeros.
  const Vector& home() const { return home_; }
  const Vector& rest() const { return rest_; }
  /// A length typical of the mechanism, m: of the transforms to the end effector, or where all of them vary,
  /// of its move by a motor's unit.
  double scale() const { return scale_; }
  /// Of each motor, the move that takes the end effector, at home, about as far as that (where it takes it
  /// nowhere, 1 rad or that length): the measure of what is near in the motors' space. An oriented one is
  /// taken as far by turning by 1 rad.
  const Vector& motor_scale() const { return motor_scale_; }

 private:
  Vector moved_at_home();

  const Model<double>& model_;
  Workspace<double> ws_;
  Vector home_, rest_, motor_scale_, psidd_;
  double scale_ = 1;
};

}  // namespace mixloop
