// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dynamics/assembly/partitions.hpp"
#include "dynamics/scene/coordinate_values.hpp"
#include "dynamics/scene/scene.hpp"
#include "integrators/method.hpp"
#include "notation/document.hpp"
#include "plant/actuators.hpp"
#include "plant/faults.hpp"
#include "plant/sensors.hpp"

namespace mixloop {

struct PlantSettings {
  bool continuous = false;  ///< control evaluated at every stage of the integrator, else held over the tick
  Method integrator = Method::rk4;
  bool automatic = false;  ///< the integrator and its substeps are to be chosen (loop/integrator_choice.hpp)
  int substeps = 1;        ///< equal steps in a tick (in each part of it, where a command delay splits it)
  double local_error =
      0;  ///< above 0: what each step (automatic: each tick) may add, as error_size measures it
  double command_delay = 0;          ///< s: COMMAND(k) acts from t_k + command_delay on
  std::vector<double> torque_limit;  ///< n_u, N m or N: what the motors can give; empty: no limit
  std::vector<double> initial_psi;   ///< n, rad or m: where it stands at first; empty: at the path's start
  std::vector<double> initial_psid;  ///< n, rad/s or m/s: of a motion without a path; empty: at rest
  /// Where closures come near a singular pose, the coordinates that are switched to; null: the run stops
  /// there.
  std::shared_ptr<const std::vector<Partition>> partitions;
  SensorSettings sensors;
  ActuatorSettings actuators;
  FaultSettings faults;
  std::uint64_t seed = 1;          ///< of what is random in sensors and faults
  std::vector<double> parameters;  ///< the scene's, before any fault; empty: their defaults

  /// Whether a run draws random numbers.
  bool random() const { return sensors.random() || faults.random() || faults.injected; }
};

/// The scene's parameters before any fault.
std::vector<double> parameters_of(const PlantSettings& settings, const Scene& scene);

/// The settings without sensors, actuators, faults.
PlantSettings ideal(PlantSettings settings);

/// Reads `{integrator, local_error, control, substeps, command_delay, torque_limit, initial,
/// initial_rates, near_singular, sensors, actuators}`; `parameters` belongs to the experiment. Sensors need
/// the rate.
PlantSettings read_plant_settings(const NodePtr& node, const Scene& scene, double rate_hz);

}  // namespace mixloop
