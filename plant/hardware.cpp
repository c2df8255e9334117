// SPDX-License-Identifier: MIT
#include "plant/hardware.hpp"

#include <fmt/format.h>

namespace mixloop {

Hardware::Hardware(const PlantSettings& settings, const Scene& scene, double rate_hz)
    : n_u(scene.motors().size()) {
  if (settings.actuators.any()) actuators.emplace(settings.actuators, n_u);
  if (settings.sensors.any() || settings.faults.any())
    sensors.emplace(settings.sensors, settings.seed, scene.independent.size(), rate_hz);
  if (settings.faults.any())
    faults.emplace(settings.faults, settings.seed, scene, rate_hz, parameters_of(settings, scene));
}

HardwareState Hardware::state() const {
  HardwareState state{.asked = Vector::Zero(static_cast<Eigen::Index>(n_u))};
  if (actuators) state.actuators = actuators->state();
  if (sensors) state.sensors = sensors->state();
  if (faults) state.faults = faults->state();
  return state;
}

void check_hardware(const PlantSettings& settings, const NodePtr& entry, const NodePtr& faults) {
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError("out_of_range", (entry ? find_entry(*entry, key) : faults)->place, why);
  };
  const ActuatorSettings& actuators = settings.actuators;
  if (actuators.any() && facts(settings.integrator).jacobian)
    refuse("actuators", fmt::format("{} takes the Jacobian of ideal drives; expected another integrator",
                                    facts(settings.integrator).name));
  if (!settings.continuous) return;
  if (settings.sensors.any() || !settings.sensors.unmeasured.empty())
    refuse("sensors",
           "with control: continuous the control law sees every stage, and sensors have a sample a tick; "
           "expected control: held");
  if (actuators.has_memory())
    refuse("actuators",
           "with control: continuous no torque stays for a rate limit or a lag to follow; expected "
           "control: held, or ripple and friction alone");
  for (const Fault& fault : settings.faults.scheduled)
    if (fault.target == Fault::Target::motor || fault.target == Fault::Target::sensor)
      throw InputError(
          "out_of_range", faults->place,
          "with control: continuous motors and sensors have no ticks for a fault to go by; expected "
          "control: held, or parameters and friction alone");
}

}  // namespace mixloop
