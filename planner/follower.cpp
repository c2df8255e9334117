// SPDX-License-Identifier: MIT
#include "planner/follower.hpp"

namespace mixloop {

IkOutcome Follower::start(const InverseKinematics::Accepts& accepts) {
  if (!ik_) return follow_motors(0);
  const PathPoint desired = itinerary_.at(0);
  const IkOutcome outcome = ik_->position_from_home(desired, time(0), now_.motors.psi, accepts);
  return outcome == IkOutcome::solved ? complete(0, desired, now_.motors.psi) : outcome;
}

IkOutcome Follower::complete(double step, const PathPoint& desired, Vector psi) {
  Motion next{step, desired, {std::move(psi), {}, {}}};
  const IkOutcome outcome =
      ik_->rates(desired, time(step), next.motors.psi, next.motors.psid, next.motors.psidd);
  if (outcome == IkOutcome::solved) now_ = std::move(next);
  return outcome;
}

IkOutcome Follower::advance(double step) {
  return ik_ ? try_advance(step, ik_->arm() ? 0 : 12) : follow_motors(step);
}

// The end effector is wanted where the motors bring it.
IkOutcome Follower::follow_motors(double step) {
  Motion next{step, {}, itinerary_.motors_at(step)};
  const auto& [psi, psid, psidd] = next.motors;
  const auto& state = hand_->at(psi, psid, psidd, time(step));
  if (!state.acceleration.allFinite()) return IkOutcome::out_of_reach;
  next.desired.position = state.position;
  next.desired.velocity = state.velocity;
  next.desired.acceleration = state.acceleration;
  now_ = std::move(next);
  return IkOutcome::solved;
}

// Where the motion in hand leads. Of a redundant mechanism the pose is a matter of the way there: by Runge
// and Kutta's classical step.
Vector Follower::expected(double step) {
  const double dt = time(step) - time(now_.step);
  const auto& [psi, psid, psidd] = now_.motors;
  if (ik_->arm()) return psi;
  if (!ik_->is_redundant()) return psi + (dt * psid + dt * dt / 2 * psidd);
  const auto slope = [&](double part, const Vector& at) {
    const double there = now_.step + part * (step - now_.step);
    Vector rates = Vector::Zero(at.size());
    ik_->velocity(itinerary_.at(there), time(there), at, rates);
    return rates;
  };
  const Vector& k1 = psid;
  const Vector k2 = slope(0.5, psi + dt / 2 * k1), k3 = slope(0.5, psi + dt / 2 * k2),
               k4 = slope(1, psi + dt * k3);
  return psi + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

// A solution far from where the motion in hand leads, or far away and not just there, may lie on another
// branch: go there in smaller steps.
IkOutcome Follower::try_advance(double step, int halvings) {
  const PathPoint desired = itinerary_.at(step);
  const Vector expected = this->expected(step), from = now_.motors.psi;
  Vector psi = expected;
  const IkOutcome outcome = ik_->position(desired, time(step), psi);
  const auto size = [&](const Vector& move) { return move.cwiseQuotient(ik_->motor_scale()).norm(); };
  const double move = size(psi - from), off = size(psi - expected);
  const bool far =
      outcome != IkOutcome::solved || off > 0.1 * move + 1e-3 || (move > 0.3 && off > 1e-3 * move);
  if (far && halvings > 0) {
    const IkOutcome half = try_advance((now_.step + step) / 2, halvings - 1);
    return half == IkOutcome::solved ? try_advance(step, halvings - 1) : half;
  }
  if (outcome != IkOutcome::solved) return outcome;
  return ik_->arm() || !far ? complete(step, desired, psi) : IkOutcome::singular;
}

double Follower::limit(double failed) {
  double reached = now_.step;
  while (reached < failed) {
    const double middle = (reached + failed) / 2;
    if (middle <= reached || middle >= failed) break;
    (advance(middle) == IkOutcome::solved ? reached : failed) = middle;
  }
  return failed;
}

}  // namespace mixloop
