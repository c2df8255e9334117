// SPDX-License-Identifier: MIT
#pragma once

#include "controller/controller_settings.hpp"
#include "dynamics/equations.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// Of psidd by psi, psid and tau, n x 3n, exact, at the torque that gives psidd there. `dynamics` serves
/// inverse_dynamics and linearisation.
Matrix forward_dynamics_slopes(Equations::Workspace& dynamics, const Vector& psi, const Vector& psid,
                               const Vector& psidd, double t);

/// Derivatives of the inverse dynamics tau(psi, psid, psidd), n x n each, exact: with the forward dynamics
/// psidd(psi, psid, tau), d tau / d psi = -M d psidd / d psi and so for psid; M from d psidd / d tau = M^-1.
/// `dynamics` serves inverse_dynamics and linearisation.
struct InverseDynamicsSlope {
  Matrix by_psi, by_psid;
};
InverseDynamicsSlope inverse_dynamics_slope(Equations::Workspace& dynamics, const Vector& psi,
                                            const Vector& psid, const Vector& psidd, double t);

/// What a control law answers to small deviations from its reference: d tau = gain (d psi, d psid).
/// `proportional` scales with Kp and Kv, `model` comes from the equations of motion at the measured state.
struct Feedback {
  Matrix proportional, model;  ///< n x 2n each

  Matrix gain() const { return proportional + model; }
};
/// Of the law at a reference; `model` is what the controller takes the robot for, with inverse_dynamics and
/// linearisation.
Feedback feedback(const ControllerSettings& settings, Equations::Workspace& model, const Reference& reference,
                  double t);

}  // namespace mixloop
