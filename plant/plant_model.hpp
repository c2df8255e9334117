// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "integrators/integrator.hpp"
#include "plant/plant_settings.hpp"

namespace mixloop {

/// What of a plant stays as it is: its rate, its method, its limits.
struct PlantModel {
  std::size_t n = 0;  ///< motors
  double rate_hz = 1000;
  IntegratorSettings integrator;
  bool jacobian = false;             ///< the method takes one
  bool timed = false;                ///< the forward dynamics depend on time
  std::vector<double> torque_limit;  ///< n; empty: none
  std::size_t delay_ticks = 0;       ///< whole ticks of the command delay
  double delay_rest = 0;             ///< and the rest, s

  double tick_length() const { return 1.0 / rate_hz; }
  double time(std::int64_t tick) const { return static_cast<double>(tick) / rate_hz; }  ///< t_k = k / rate
};

PlantModel plant_model(const PlantSettings& settings, const Scene& scene, double rate_hz);

}  // namespace mixloop
