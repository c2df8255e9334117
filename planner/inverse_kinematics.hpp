// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "planner/path.hpp"
#include "planner/prescription.hpp"
#include "planner/three_axis_arm.hpp"

namespace mixloop {

/// What became of a search for the motors' motion. What is expected to happen is no exception.
enum class IkOutcome {
  solved,
  out_of_reach,  ///< the closed form has no solution; or the search ended at a nearest point that is none
  other_branch,  ///< the search from home found solutions on other branches only
  singular,      ///< the Jacobian has no inverse there, to round-off
};

/// From a desired motion of the end effector to that of the motors. Closed form for the paper's family
/// (ThreeAxisArm), else Newton's method by the exact Jacobian, damped where it has to be. The branch is the
/// one of the scene's home, where free coordinates stay, and motors that are held. Where more motors may move
/// than numbers are prescribed, their velocity is the least of those that serve, each in units of its
/// `motor_scale`: a pose then is a matter of the way there.
class InverseKinematics {
 public:
  enum class Method { closed_form_if_known, newton };
  using Accepts = std::function<bool(const Vector& psi)>;
  /// Of motors that are more than the end effector's path prescribes: a path's.
  struct Redundancy {
    std::vector<int> held = {};
    bool least_norm = false;
  };

  /// Throws InputError("no_inverse") where fewer motors may move than numbers are prescribed, or more, and
  /// nothing says what becomes of these. Refers to `model`.
  explicit InverseKinematics(const Model<double>& model, Method method = Method::closed_form_if_known)
      : InverseKinematics(model, method, {}) {}
  InverseKinematics(const Model<double>& model, Method method, const Redundancy& redundancy);
  InverseKinematics(const InverseKinematics&) = delete;

  /// The arm whose closed form is used, or nothing.
  const std::optional<ThreeAxisArm>& arm() const { return arm_; }
  bool is_redundant() const { return prescription_.active() > prescription_.rows(); }
  HandKinematics& hand() { return hand_; }
  Prescription& prescription() { return prescription_; }
  double scale() const { return hand_.scale(); }
  const Vector& motor_scale() const { return hand_.motor_scale(); }

  /// The psi that bring the end effector to `point` (of it, what is prescribed counts) at time t, to
  /// round-off. `psi`: a solution or guess nearby, of which the new one is the continuation; where the search
  /// fails, the nearest that it found.
  IkOutcome position(const PathPoint& point, double t, Vector& psi);
  IkOutcome position(const Eigen::Vector3d& point, double t, Vector& psi) {
    return position(PathPoint{.position = point}, t, psi);
  }

  /// The same from home: of the solutions on home's branch that `accepts` too, the one nearest to home.
  IkOutcome position_from_home(const PathPoint& point, double t, Vector& psi, const Accepts& accepts = {});
  IkOutcome position_from_home(const Eigen::Vector3d& point, double t, Vector& psi,
                               const Accepts& accepts = {}) {
    return position_from_home(PathPoint{.position = point}, t, psi, accepts);
  }

  /// psid and psidd that go with a path's velocity and acceleration, at the psi of its position:
  /// J psid = v - E_t, J psidd = a - (E'' where psidd = 0); of a redundant scene psid the least and psidd its
  /// rate.
  IkOutcome rates(const PathPoint& point, double t, const Vector& psi, Vector& psid, Vector& psidd);
  /// psid alone.
  IkOutcome velocity(const PathPoint& point, double t, const Vector& psi, Vector& psid);

  /// The end effector for given motors (n_u each), in a workspace that the next call overwrites.
  const EndEffectorState<double>& forward(const Vector& psi, const Vector& psid, const Vector& psidd,
                                          double t) {
    return hand_.at(psi, psid, psidd, t);
  }

  /// How far the end effector at psi is from `point` in what is prescribed, m; angles by the mechanism's
  /// scale.
  double miss(const PathPoint& point, double t, const Vector& psi) {
    return prescription_.miss(point, t, psi).error.norm();
  }
  double miss(const Eigen::Vector3d& point, double t, const Vector& psi) {
    return miss(PathPoint{.position = point}, t, psi);
  }

 private:
  IkOutcome closed_form(const Eigen::Vector3d& point, Vector& psi) const;
  IkOutcome closed_form_rates(const PathPoint& point, Vector& psid, Vector& psidd) const;
  /// Whether the end effector goes straight to `point`, from which `error` parts it, as the motors go on by
  /// `step`.
  bool leads_straight(const PathPoint& point, double t, const Vector& psi, const Vector& step,
                      const Vector& error);
  /// What the rounding of a point and of the motors' angles leaves of the end effector's place, m.
  double resolution(const PathPoint& point) const;
  Vector active_scale() const { return prescription_.on_active(hand_.motor_scale()); }

  HandKinematics hand_;
  Prescription prescription_;
  std::optional<ThreeAxisArm> arm_;
};

}  // namespace mixloop
