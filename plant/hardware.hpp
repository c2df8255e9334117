// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "plant/plant_settings.hpp"
#include "plant/plant_state.hpp"

namespace mixloop {

/// Where a plant isn't ideal: its drives, its sensors, what goes wrong with them; all constant. A plant that
/// is ideal has none.
struct Hardware {
  /// Whether settings ask for any.
  static bool needed(const PlantSettings& settings) {
    return settings.sensors.any() || settings.actuators.any() || settings.faults.any();
  }

  Hardware(const PlantSettings& settings, const Scene& scene, double rate_hz);

  /// Before anything has happened.
  HardwareState state(std::size_t n) const;

  std::optional<Actuators> actuators;
  std::optional<Sensors> sensors;
  std::optional<Faults> faults;
};

/// Throws InputError where sensors, actuators or faults can't be right with how the plant is integrated and
/// controlled. `entry`: the experiment's `plant`; `faults` its faults; either may be null.
void check_hardware(const PlantSettings& settings, const NodePtr& entry, const NodePtr& faults);

}  // namespace mixloop
