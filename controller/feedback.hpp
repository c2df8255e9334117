// SPDX-License-Identifier: MIT
#pragma once

#include "controller/controller_settings.hpp"
#include "dynamics/equations.hpp"
#include "planner/motion.hpp"

namespace mixloop {

/// Of psidd by psi, psid (n x n each) and tau (n x n_u), exact, at the motors' part of the torque that gives
/// `at` (n). `dynamics` serves inverse_dynamics and linearisation.
Matrix forward_dynamics_slopes(Equations::Workspace& dynamics, const PsiMotion& at, double t);

/// Derivatives of the inverse dynamics tau(psi, psid, psidd), n x n each, exact: with the forward dynamics
/// psidd(psi, psid, tau), d tau / d psi = -M d psidd / d psi and so for psid; M from d psidd / d tau = M^-1.
/// `dynamics`, of a scene that is fully_driven, serves inverse_dynamics and linearisation.
struct InverseDynamicsSlope {
  Matrix by_psi, by_psid;
};
InverseDynamicsSlope inverse_dynamics_slope(Equations::Workspace& dynamics, const PsiMotion& at, double t);

/// What a control law answers to small deviations from its reference: d tau = gain (d psi, d psid).
/// `proportional` scales with Kp and Kv, or K, `model` comes from the equations of motion at the measured
/// state.
struct Feedback {
  Matrix proportional, model;  ///< n_u x 2n each

  Matrix gain() const { return proportional + model; }
};
/// Of the law where the robot is `at` its reference (n), the free coordinates at rest; `model` is what the
/// controller takes it for, fully_driven, with inverse_dynamics and linearisation; `of_model`: which of the
/// robot's coordinates its own are, none: all.
Feedback feedback(const ControllerSettings& settings, Equations::Workspace& model, const PsiMotion& at,
                  double t, std::span<const int> of_model = {});

}  // namespace mixloop
