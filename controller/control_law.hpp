// SPDX-License-Identifier: MIT
#pragma once

#include "controller/controller_settings.hpp"
#include "controller/measurement.hpp"
#include "dynamics/evaluator.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// The control laws, each a pure function of what is measured and desired; the model is what the controller
/// knows of the robot, not what the plant is.
class Controller {
 public:
  Controller(Dynamics dynamics, ControllerSettings settings);

  /// tau (n_u). Allocates nothing.
  void torque(const Measurement& now, const Reference& desired, std::span<double> tau);

 private:
  Dynamics dynamics_;
  ControllerSettings settings_;
  Vector psi_, psid_;          ///< n: where the model is evaluated
  Vector feedforward_, bias_;  ///< n_u, n
};

}  // namespace mixloop
