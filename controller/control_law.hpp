// SPDX-License-Identifier: MIT
#pragma once

#include "controller/controller_settings.hpp"
#include "controller/measurement.hpp"
#include "dynamics/equations.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// The control laws, each a pure function of what is measured and desired; the model is what the controller
/// knows of the robot, not what the plant is.
class Controller {
 public:
  /// `seen`: of each coordinate that the law takes, those of state_feedback or of the model, its place in
  /// what is measured; -1 where it isn't, and none: each at its own.
  Controller(Equations::Workspace dynamics, ControllerSettings settings, std::vector<int> seen = {});

  /// tau (n_u). Allocates nothing.
  void torque(const Measurement& now, const Reference& desired, std::span<double> tau);

  const Equations& equations() const { return dynamics_.equations(); }
  const Scene& scene() const { return dynamics_.scene(); }

 private:
  void take(const Measurement& now);
  void feed_back(const Measurement& now, const Reference& desired, std::span<double> tau);

  Equations::Workspace dynamics_;
  ControllerSettings settings_;
  std::vector<int> seen_;
  Vector psi_, psid_;          ///< n: where the model is evaluated, or how far off the state is
  Vector feedforward_, bias_;  ///< n_u, n
};

}  // namespace mixloop
