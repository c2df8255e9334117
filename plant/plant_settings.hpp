// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/scene/motor_values.hpp"
#include "dynamics/scene/scene.hpp"
#include "integrators/method.hpp"
#include "notation/document.hpp"

namespace mixloop {

struct PlantSettings {
  bool continuous = false;  ///< control evaluated at every stage of the integrator, else held over the tick
  Method integrator = Method::rk4;
  bool automatic = false;  ///< the integrator and its substeps are to be chosen (loop/integrator_choice.hpp)
  int substeps = 1;        ///< equal steps in a tick (in each part of it, where a command delay splits it)
  double local_error =
      0;  ///< above 0: what each step (automatic: each tick) may add, as error_size measures it
  double command_delay = 0;          ///< s: COMMAND(k) acts from t_k + command_delay on
  std::vector<double> torque_limit;  ///< n, N m or N: what the motors can give; empty: no limit
  std::vector<double> initial_psi;   ///< n, rad or m: where it stands at first; empty: at the path's start
};

/// Reads `{integrator, local_error, control, substeps, command_delay, torque_limit, initial}`; `parameters`
/// belongs to the experiment.
PlantSettings read_plant_settings(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
