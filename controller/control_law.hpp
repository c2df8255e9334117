// SPDX-License-Identifier: MIT
#pragma once

#include "controller/controller_settings.hpp"
#include "dynamics/equations.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// The control laws, each a pure function of (measured state, reference, time); the model is what the
/// controller knows of the robot, not what the plant is.
class Controller {
 public:
  Controller(Equations::Workspace dynamics, ControllerSettings settings);

  /// tau (n) for the measured psi, psid at time t. Allocates nothing.
  void torque(std::span<const double> psi, std::span<const double> psid, const Reference& reference, double t,
              std::span<double> tau);

  const Equations& equations() const { return dynamics_.equations(); }

 private:
  Equations::Workspace dynamics_;
  ControllerSettings settings_;
  Vector model_torque_, at_rest_;
};

}  // namespace mixloop
