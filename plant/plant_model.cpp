// SPDX-License-Identifier: MIT
#include "plant/plant_model.hpp"

#include <cmath>

#include "dynamics/scene/time_dependence.hpp"

namespace mixloop {

PlantModel plant_model(const PlantSettings& settings, const Scene& scene, double rate_hz) {
  PlantModel model{.n = static_cast<std::size_t>(scene.n()),
                   .rate_hz = rate_hz,
                   .integrator = {settings.integrator, settings.substeps, settings.local_error},
                   .jacobian = facts(settings.integrator).jacobian,
                   .timed = constraints_depend_on_time(scene) || loads_depend_on_time(scene),
                   .torque_limit = settings.torque_limit};
  // A delay within a billionth of whole ticks is whole.
  const double ticks = settings.command_delay * rate_hz;
  model.delay_ticks = static_cast<std::size_t>(std::floor(ticks + 1e-9));
  const double rest = ticks - static_cast<double>(model.delay_ticks);
  model.delay_rest = rest > 1e-9 ? rest / rate_hz : 0;
  return model;
}

}  // namespace mixloop
