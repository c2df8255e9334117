// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "dynamics/procedure/matrix.hpp"
#include "plant/plant_settings.hpp"

namespace mixloop {

/// Where a plant isn't ideal: its drives, its sensors, what goes wrong with them. A plant that is ideal has
/// none.
class Hardware {
 public:
  /// Whether settings ask for any.
  static bool needed(const PlantSettings& settings) {
    return settings.sensors.any() || settings.actuators.any() || settings.faults.any();
  }

  Hardware(const PlantSettings& settings, const Scene& scene, double rate_hz);
  ~Hardware();
  Hardware(const Hardware&) = delete;
  Hardware& operator=(const Hardware&) = delete;

  std::optional<Actuators> actuators;
  std::optional<Sensors> sensors;
  std::optional<Faults> faults;

  /// A command as the motors' faults let it through, until the next call; it is kept as asked_.
  std::span<const double> through_faults(std::int64_t tick, std::span<const double> tau);
  bool was_asked() const { return was_asked_; }
  std::span<const double> asked() const { return span_of(asked_); }  ///< the latest command

  double friction() const { return faults ? faults->friction() : 1; }

 private:
  Vector asked_, faulted_;
  bool was_asked_ = false;
};

/// Throws InputError where sensors, actuators or faults can't be right with how the plant is integrated and
/// controlled. `entry`: the experiment's `plant`; `faults` its faults; either may be null.
void check_hardware(const PlantSettings& settings, const NodePtr& entry, const NodePtr& faults);

}  // namespace mixloop
