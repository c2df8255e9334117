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
  void set_parameters(std::span<const double> parameters, double friction);

  struct Arguments {
    std::span<const double> psi, psid, tau;
    double t;
  };
  /// Forward dynamics or their linearisation.
  void evaluate(Purpose purpose, const Arguments& at, std::span<double> out) {
    if (purpose == Purpose::linearisation) {
      dynamics_.linearisation(at.psi, at.psid, at.tau, at.t, out);
      if (factor_ != 1) friction_->scale_slopes(at.psi, at.psid, at.tau, at.t, factor_, out);
    } else {
      dynamics_.forward_dynamics(at.psi, at.psid, at.tau, at.t, out);
      if (factor_ != 1) friction_->scale(at.psi, at.psid, at.tau, at.t, factor_, out);
    }
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
