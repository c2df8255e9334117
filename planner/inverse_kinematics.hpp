// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "dynamics/procedure/procedure.hpp"
#include "planner/motion.hpp"
#include "planner/three_axis_arm.hpp"

namespace mixloop {

/// What became of a search for the motors' motion. What is expected to happen is no exception.
enum class IkOutcome {
  solved,
  out_of_reach,  ///< the closed form has no solution; or the search ended at a nearest point that is none
  other_branch,  ///< the search from home found solutions on other branches only
  singular,      ///< the Jacobian has no inverse there, to round-off
};

/// From a desired motion of the end effector to that of the motors, for a scene with as many motors as its
/// end effector has axes. Closed form for the paper's family (ThreeAxisArm), else Newton's method by the
/// exact Jacobian, damped where it has to be. The branch is the one of the scene's home, where free
/// coordinates stay.
class InverseKinematics {
 public:
  enum class Method { closed_form_if_known, newton };
  using Accepts = std::function<bool(const Vector& psi)>;

  /// Throws InputError("no_inverse") unless there are as many motors as the end effector has axes. Refers to
  /// `model`.
  explicit InverseKinematics(const Model<double>& model, Method method = Method::closed_form_if_known);

  /// The arm whose closed form is used, or nothing.
  const std::optional<ThreeAxisArm>& arm() const { return arm_; }
  /// A length typical of the mechanism, m: of the transforms to the end effector, or where all of them vary,
  /// of its move by a motor's unit.
  double scale() const { return scale_; }
  /// Of each motor, the move that takes the end effector, at home, about as far as that (where it takes it
  /// nowhere, 1 rad or that length): the measure of what is near in the motors' space.
  const Vector& motor_scale() const { return motor_scale_; }

  /// The psi that bring the end effector to `point` (of it, the scene's axes count) at time t, to round-off.
  /// `psi`: a solution or guess nearby, of which the new one is the continuation; where the search fails,
  /// the nearest that it found.
  IkOutcome position(const Eigen::Vector3d& point, double t, Vector& psi);

  /// The same from home: of the solutions on home's branch that `accepts` too, the one nearest to home.
  IkOutcome position_from_home(const Eigen::Vector3d& point, double t, Vector& psi,
                               const Accepts& accepts = {});

  /// psid and psidd that go with a path's velocity and acceleration, at the psi of its position:
  /// J psid = v - E_t, J psidd = a - (E'' where psidd = 0).
  IkOutcome rates(const PathPoint& point, double t, const Vector& psi, Vector& psid, Vector& psidd);

  /// The end effector for given motors (n_u each), in a workspace that the next call overwrites.
  const EndEffectorState<double>& forward(const Vector& psi, const Vector& psid, const Vector& psidd,
                                          double t);

  /// How far the end effector at psi is from `point` over the scene's axes, m.
  double miss(const Eigen::Vector3d& point, double t, const Vector& psi);

 private:
  IkOutcome closed_form(const Eigen::Vector3d& point, Vector& psi) const;
  IkOutcome closed_form_rates(const PathPoint& point, Vector& psid, Vector& psidd) const;
  /// How far a unit of each motor takes the end effector at home, m; 0 where that is nothing but rounding.
  Vector moved_at_home();
  /// Whether the end effector goes straight to `point`, from which `error` parts it, as the motors go on by
  /// `step`.
  bool leads_straight(const Eigen::Vector3d& point, double t, const Vector& psi, const Vector& step,
                      const Eigen::Vector3d& error);
  /// What the rounding of a point and of the motors' angles leaves of the end effector's place, m.
  double resolution(const Eigen::Vector3d& point) const;
  // With fewer than three motors the systems of three equations are filled up by x_i = 0.
  Eigen::Vector3d on_axes(const Eigen::Vector3d& x) const;
  Eigen::Matrix3d jacobian_of(const EndEffectorState<double>& state) const;

  const Model<double>& model_;
  int n_u_;
  std::optional<ThreeAxisArm> arm_;
  Workspace<double> ws_;
  Vector home_, zero_, motor_scale_;
  double scale_ = 1;
};

}  // namespace mixloop
