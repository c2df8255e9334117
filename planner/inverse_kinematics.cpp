// SPDX-License-Identifier: MIT
#include "planner/inverse_kinematics.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "notation/long_work.hpp"

namespace mixloop {
namespace {

constexpr int kMostIterations = 100;
constexpr int kStartsFromHome = 400;
constexpr double kFarthestStart = 4;  // in motor scales: about a half turn of a joint and more

constexpr double kRoundOff = std::numeric_limits<double>::epsilon();
constexpr double kNothing = 1e3 * kRoundOff;  // of what a sum consists of: a sum of nothing
constexpr double kStraight = 1e-3;            // of a way: how far the end effector may be off it

/// Of the transforms from the ground to the end effector, and the point in its frame; 0 where all of it
/// varies.
double length_of_chain(const Model<double>& model) {
  double length = model.end_effector_point.norm();
  for (int frame = model.scene->end_effector.frame; frame != 0;) {
    const auto& link = model.links[static_cast<std::size_t>(frame - 1)];
    length += std::abs(link.a) + std::abs(link.s);
    frame = link.parent;
  }
  return length;
}

/// The first n of three.
Vector first_of(const Eigen::Vector3d& x, int n) {
  Vector first(n);
  for (int i = 0; i < n; ++i) first[i] = x[i];
  return first;
}

/// Marquardt's step (J^T J + damping diag(J^T J)) x = J^T error (SIAM J. 11, 1963), worked out in units of
/// `scale`; undamped, Newton's. Of three equations the first `scale.size()` count.
Eigen::Vector3d damped_step(const Eigen::Matrix3d& J, const Eigen::Vector3d& error, double damping,
                            const Vector& scale) {
  if (damping == 0) return J.partialPivLu().solve(error);
  Eigen::Vector3d unit = Eigen::Vector3d::Ones();
  unit.head(scale.size()) = scale;
  const Eigen::Matrix3d scaled = J * unit.asDiagonal();
  Eigen::Matrix3d A = scaled.transpose() * scaled;
  const double least = 1e-12 * A.diagonal().head(scale.size()).maxCoeff();
  for (int i = 0; i < 3; ++i) A(i, i) += damping * std::max(A(i, i), least);
  return unit.cwiseProduct(A.partialPivLu().solve(scaled.transpose() * error));
}

/// The angle that differs from `angle` by whole turns and is nearest to `other`.
double unwrapped(double angle, double other) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((other - angle) / turn);
}

}  // namespace

InverseKinematics::InverseKinematics(const Model<double>& model, Method method)
    : model_(model),
      n_u_(model.n_u()),
      ws_(model),
      home_(Eigen::Map<const Vector>(model.scene->home.data(), n_u_)),
      zero_(Vector::Zero(n_u_)),
      scale_(length_of_chain(model)) {
  const std::size_t axes = model.scene->end_effector.axes.size();
  if (axes != static_cast<std::size_t>(n_u_))
    throw InputError("no_inverse", {model.scene->transforms.front().place.file},
                     fmt::format("the scene '{}' has {} motors for {} axes of its end effector; a path needs "
                                 "as many motors as axes",
                                 model.scene->name, n_u_, axes));
  if (method == Method::closed_form_if_known) arm_ = find_three_axis_arm(model);
  const Vector moved = moved_at_home();
  if (!(scale_ > 0)) scale_ = moved.maxCoeff() > 0 ? moved.maxCoeff() : 1;
  motor_scale_ = Vector(n_u_);
  for (int i = 0; i < n_u_; ++i) {
    const bool linear = model.scene->motors()[static_cast<std::size_t>(i)].linear;
    motor_scale_[i] = moved[i] > 0 ? scale_ / moved[i] : (linear ? scale_ : 1);
  }
}

// A column of the Jacobian is nothing where it is the rounding of the joints' shares that it is summed up
// from: so however fine a drive is, and whatever its units.
Vector InverseKinematics::moved_at_home() {
  const Scene& scene = *model_.scene;
  const Eigen::Matrix3d J = jacobian_of(forward(home_, zero_, zero_, 0));
  const PsiMotion home = with_free_at_home(scene, {home_, {}, {}});
  coordinates<double>(model_, span_of(home.psi), 0.0, ws_);
  Vector moved(n_u_), shares = Vector::Zero(n_u_);
  for (int frame = scene.end_effector.frame; frame != 0;) {
    const auto& link = model_.links[static_cast<std::size_t>(frame - 1)];
    frame = link.parent;
    if (link.coordinate < 0) continue;
    const double arm = std::abs(link.scale) * (link.prismatic ? 1 : scale_);
    shares += arm * ws_.C.row(link.coordinate).head(n_u_).cwiseAbs().transpose();
  }
  for (int i = 0; i < n_u_; ++i) {
    moved[i] = J.col(i).head(n_u_).norm();
    if (!(moved[i] > kNothing * shares[i])) moved[i] = 0;
  }
  return moved;
}

// By the motors' angles at home: what a search winds up beyond them resolves nothing.
double InverseKinematics::resolution(const Eigen::Vector3d& point) const {
  return 4 * kRoundOff *
         (on_axes(point).norm() + scale_ * home_.cwiseQuotient(motor_scale_).cwiseAbs().sum());
}

IkOutcome InverseKinematics::closed_form(const Eigen::Vector3d& point, Vector& psi) const {
  const ArmReach reach = reach_of(*arm_, point);
  if (!(reach.beside >= 0 && reach.distance >= arm_->nearest() && reach.distance <= arm_->farthest()))
    return IkOutcome::out_of_reach;
  const auto angles = arm_angles<double>(*arm_, {point[0], point[1], point[2]});
  const Eigen::Vector3d before = arm_->angles(psi);
  psi = arm_->motors(
      {unwrapped(angles[0], before[0]), unwrapped(angles[1], before[1]), unwrapped(angles[2], before[2])});
  return psi.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

// The closed form on Taylor series in time: its rates are exact.
IkOutcome InverseKinematics::closed_form_rates(const PathPoint& point, Vector& psid, Vector& psidd) const {
  using Series = Taylor<double>;
  const auto along = [&](int i) {
    return Series(point.position[i], point.velocity[i], point.acceleration[i]);
  };
  const auto [base, shoulder, elbow] = arm_angles<Series>(*arm_, {along(0), along(1), along(2)});
  psid = arm_->B_inverse * Eigen::Vector3d(base.d, shoulder.d, elbow.d);
  psidd = arm_->B_inverse * Eigen::Vector3d(base.dd, shoulder.dd, elbow.dd);
  return psid.allFinite() && psidd.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

Eigen::Vector3d InverseKinematics::on_axes(const Eigen::Vector3d& x) const {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Eigen::Index i = 0;
  for (const int axis : model_.scene->end_effector.axes) values[i++] = x[axis];
  return values;
}

Eigen::Matrix3d InverseKinematics::jacobian_of(const EndEffectorState<double>& state) const {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  Eigen::Index i = 0;
  for (const int axis : model_.scene->end_effector.axes)
    J.row(i++).head(n_u_) = state.jacobian.row(axis).head(n_u_);
  return J;
}

const EndEffectorState<double>& InverseKinematics::forward(const Vector& psi, const Vector& psid,
                                                           const Vector& psidd, double t) {
  work_goes_on();  // of a large scene one takes long, and refusals take thousands
  const PsiMotion all = with_free_at_home(*model_.scene, {psi, psid, psidd});
  return end_effector<double>(model_, span_of(all.psi), span_of(all.psid), span_of(all.psidd), t, ws_);
}

double InverseKinematics::miss(const Eigen::Vector3d& point, double t, const Vector& psi) {
  return on_axes(point - forward(psi, zero_, zero_, t).position).norm();
}

// A fine drive and a long slide have far to go, and where the end effector follows the step all along,
// nothing winds up.
bool InverseKinematics::leads_straight(const Eigen::Vector3d& point, double t, const Vector& psi,
                                       const Vector& step, const Eigen::Vector3d& error) {
  for (const double part : {0.25, 0.5, 1.0}) {
    const Eigen::Vector3d left = on_axes(point - forward(psi + part * step, zero_, zero_, t).position);
    if (!((left - (1 - part) * error).norm() <= kStraight * error.norm())) return false;
  }
  return true;
}

IkOutcome InverseKinematics::position(const Eigen::Vector3d& point, double t, Vector& psi) {
  if (arm_) return closed_form(point, psi);
  double damping = 0;
  const EndEffectorState<double>* state = &forward(psi, zero_, zero_, t);
  Eigen::Vector3d error = on_axes(point - state->position);
  Eigen::Matrix3d J = jacobian_of(*state);
  // Closures are followed all the way, and close no farther in a straight line than about a turn.
  const double farthest = model_.scene->is_closed() ? 2 * kFarthestStart : HUGE_VAL;
  for (int i = 0; i < kMostIterations; ++i) {
    const Vector step = first_of(damped_step(J, error, damping, motor_scale_), n_u_);
    const Vector trial = psi + step;
    // Longer steps would wind the motors up.
    const double length = step.cwiseQuotient(motor_scale_).norm();
    const bool sound = step.allFinite() &&
                       (length <= 0.5 || (length <= farthest && leads_straight(point, t, psi, step, error)));
    const double distance = error.norm();
    // What Newton's method still has to go is quadratically small in the step (next to a singular pose a
    // small distance may take a long one): this step ends it.
    if (sound && damping == 0 && distance <= std::max(1e-10 * scale_, resolution(point)) &&
        length <= 1e-8 + kRoundOff * psi.cwiseQuotient(motor_scale_).norm()) {
      psi = trial;
      return IkOutcome::solved;
    }
    if (sound) state = &forward(trial, zero_, zero_, t);
    if (const Eigen::Vector3d left = on_axes(point - state->position); sound && left.norm() < distance) {
      psi = trial;
      error = left;
      J = jacobian_of(*state);
      damping = damping < 1e-6 ? 0 : damping / 10;
    } else {
      damping = damping == 0 ? 1e-6 : damping * 10;
      if (damping > 1e12) break;
    }
  }
  return error.norm() <= std::max(1e-12 * scale_, resolution(point)) ? IkOutcome::solved
                                                                     : IkOutcome::out_of_reach;
}

IkOutcome InverseKinematics::position_from_home(const Eigen::Vector3d& point, double t, Vector& psi,
                                                const Accepts& accepts) {
  psi = home_;
  if (arm_) return closed_form(point, psi);
  const double det_home = jacobian_of(forward(home_, zero_, zero_, t)).determinant();
  const auto on_home_side = [&](const Vector& at) {
    return det_home * jacobian_of(forward(at, zero_, zero_, t)).determinant() >= 0 &&
           (!accepts || accepts(at));
  };
  bool found_other = false;
  double nearest = HUGE_VAL, least_miss = HUGE_VAL;
  for (int start = 0; start <= kStartsFromHome; ++start) {
    // Spread evenly about home (a Kronecker sequence), farther and farther away.
    const double spread = kFarthestStart * start / kStartsFromHome;
    if (nearest <= spread) break;
    Vector found = home_;
    for (Eigen::Index i = 0; i < found.size(); ++i)
      found[i] += spread * motor_scale_[i] *
                  (2 * std::fmod(0.5 + start * std::sqrt(static_cast<double>(2 + 3 * i)), 1.0) - 1);
    if (start > 0 && !on_home_side(found)) continue;
    if (position(point, t, found) != IkOutcome::solved) {
      const double missed = miss(point, t, found);
      if (nearest == HUGE_VAL && !found_other && missed < least_miss) psi = found;
      least_miss = std::min(least_miss, missed);
    } else if (!on_home_side(found)) {
      found_other = true;
    } else if (const double away = (found - home_).cwiseQuotient(motor_scale_).norm(); away < nearest) {
      nearest = away;
      psi = found;
    }
  }
  if (nearest < HUGE_VAL) return IkOutcome::solved;
  return found_other ? IkOutcome::other_branch : IkOutcome::out_of_reach;
}

IkOutcome InverseKinematics::rates(const PathPoint& point, double t, const Vector& psi, Vector& psid,
                                   Vector& psidd) {
  if (arm_) return closed_form_rates(point, psid, psidd);
  const EndEffectorState<double>& drift = forward(psi, zero_, zero_, t);
  const Eigen::PartialPivLU<Eigen::Matrix3d> J(jacobian_of(drift));
  psid = first_of(J.solve(on_axes(point.velocity - drift.velocity)), n_u_);
  if (!psid.allFinite()) return IkOutcome::singular;
  psidd = first_of(J.solve(on_axes(point.acceleration - forward(psi, psid, zero_, t).acceleration)), n_u_);
  return psidd.allFinite() ? IkOutcome::solved : IkOutcome::singular;
}

}  // namespace mixloop
