// SPDX-License-Identifier: MIT
#include "planner/follower.hpp"

namespace mixloop {

IkOutcome Follower::start(const InverseKinematics::Accepts& accepts) {
  const PathPoint desired = itinerary_.at(0);
  const IkOutcome outcome = ik_.position_from_home(desired.position, time(0), now_.motors.psi, accepts);
  return outcome == IkOutcome::solved ? complete(0, desired, now_.motors.psi) : outcome;
}

IkOutcome Follower::complete(double step, const PathPoint& desired, Vector psi) {
  Motion next{step, desired, {std::move(psi), {}, {}}};
  const IkOutcome outcome =
      ik_.rates(desired, time(step), next.motors.psi, next.motors.psid, next.motors.psidd);
  if (outcome == IkOutcome::solved) now_ = std::move(next);
  return outcome;
}

IkOutcome Follower::advance(double step) { return try_advance(step, ik_.arm() ? 0 : 12); }

// A solution far from where the motion in hand leads, or far away and not just there, may lie on another
// branch: go there in smaller steps.
IkOutcome Follower::try_advance(double step, int halvings) {
  const PathPoint desired = itinerary_.at(step);
  const double dt = time(step) - time(now_.step);
  const auto& [from, psid, psidd] = now_.motors;
  Vector psi = from;
  if (!ik_.arm()) psi += dt * psid + dt * dt / 2 * psidd;
  const Vector expected = psi;
  const IkOutcome outcome = ik_.position(desired.position, time(step), psi);
  const auto size = [&](const Vector& move) { return move.cwiseQuotient(ik_.motor_scale()).norm(); };
  const double move = size(psi - from), off = size(psi - expected);
  const bool far =
      outcome != IkOutcome::solved || off > 0.1 * move + 1e-3 || (move > 0.3 && off > 1e-3 * move);
  if (far && halvings > 0) {
    const IkOutcome half = try_advance((now_.step + step) / 2, halvings - 1);
    return half == IkOutcome::solved ? try_advance(step, halvings - 1) : half;
  }
  if (outcome != IkOutcome::solved) return outcome;
  return ik_.arm() || !far ? complete(step, desired, psi) : IkOutcome::singular;
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
