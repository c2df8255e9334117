// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamics/evaluator.hpp"
#include "plant/scaled_friction.hpp"

namespace mixloop {

/// A mechanism's equations of motion while faults change its parameters and its friction. Nothing allocates
/// after construction.
class ChangingDynamics {
 public:
  /// `friction_changes`: it may, where the scene has some; `linearises`: slopes are asked for.
  ChangingDynamics(Dynamics dynamics, std::span<const double> parameters, bool friction_changes,
                   bool linearises);

  /// From now on these parameters and this factor on the scene's friction.
  void change(std::span<const double> parameters, double friction);

  void forward_dynamics(std::span<const double> psi, std::span<const double> psid,
                        std::span<const double> tau, double t, std::span<double> psidd) {
    dynamics_.forward_dynamics(psi, psid, tau, t, psidd);
    if (factor_ != 1) friction_->scale(psi, psid, tau, t, factor_, psidd);
  }
  void linearisation(std::span<const double> psi, std::span<const double> psid, std::span<const double> tau,
                     double t, std::span<double> slopes) {
    dynamics_.linearisation(psi, psid, tau, t, slopes);
    if (factor_ != 1) friction_->scale_slopes(psi, psid, tau, t, factor_, slopes);
  }

  /// For what knows no friction.
  Dynamics& dynamics() { return dynamics_; }
  const Scene& scene() const { return dynamics_.scene(); }

 private:
  Dynamics dynamics_;
  std::optional<ScaledFriction> friction_;
  double factor_ = 1;  ///< 1 without friction_
};

}  // namespace mixloop
