// SPDX-License-Identifier: MIT
#include "plant/changing_dynamics.hpp"

namespace mixloop {

ChangingDynamics::ChangingDynamics(Dynamics dynamics, const PlantSettings& settings, bool linearises)
    : dynamics_(std::move(dynamics)) {
  if (settings.faults.change_friction() && has_damping(scene()))
    friction_.emplace(scene(), parameters_of(settings, scene()), dynamics_.evaluation(), linearises);
}

void ChangingDynamics::change(std::span<const double> parameters, double friction) {
  dynamics_.set_parameters(parameters);
  if (!friction_) return;
  friction_->set_parameters(parameters);
  factor_ = friction;
}

}  // namespace mixloop
