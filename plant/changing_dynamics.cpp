// SPDX-License-Identifier: MIT
#include "plant/changing_dynamics.hpp"

namespace mixloop {

ChangingDynamics::ChangingDynamics(Dynamics dynamics, std::span<const double> parameters,
                                   bool friction_changes, bool linearises)
    : dynamics_(std::move(dynamics)) {
  if (friction_changes && has_damping(scene()))
    friction_.emplace(scene(), parameters, dynamics_.evaluation(), linearises);
}

void ChangingDynamics::set_parameters(std::span<const double> parameters, double friction) {
  dynamics_.set_parameters(parameters);
  if (!friction_) return;
  friction_->set_parameters(parameters);
  factor_ = friction;
}

}  // namespace mixloop
