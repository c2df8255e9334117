// SPDX-License-Identifier: MIT
#include "plant/plant_settings.hpp"

#include <fmt/format.h>

#include "notation/value.hpp"

namespace mixloop {

std::vector<double> read_motor_values(const NodePtr& node, const Scene& scene, const Dimension& rotary,
                                      const Dimension& linear, const char* what) {
  const auto items = items_of(node, what);
  if (items.size() != scene.motors.size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected one for each of the {} motors", what,
                                 items.size(), scene.n()));
  std::vector<double> values;
  for (std::size_t i = 0; i < items.size(); ++i)
    values.push_back(number_of(*items[i], scene.motors[i].linear ? linear : rotary, what));
  return values;
}

PlantSettings read_plant_settings(const NodePtr& node, const Scene& scene) {
  const Mapping entry(
      node, "the plant",
      {"integrator", "control", "substeps", "command_delay", "torque_limit", "initial", "parameters"});
  PlantSettings settings;
  if (const NodePtr integrator = entry.find("integrator")) word_of(*integrator, {"rk4"}, "the integrator");
  if (const NodePtr control = entry.find("control"))
    settings.continuous = word_of(*control, {"held", "continuous"}, "control") == 1;
  if (const NodePtr substeps = entry.find("substeps"))
    settings.substeps = static_cast<int>(whole_number_of(*substeps, 1, 1000, "substeps"));
  if (const NodePtr delay = entry.find("command_delay")) {
    settings.command_delay = number_of(*delay, kTime, "the command delay");
    if (settings.command_delay < 0 || settings.command_delay > 1)
      throw InputError("out_of_range", delay->place,
                       fmt::format("a command delay of {} s; expected 0 to 1 s", settings.command_delay));
    if (settings.continuous && settings.command_delay > 0)
      throw InputError("out_of_range", delay->place,
                       "control: continuous has no ticks to delay; expected control: held");
  }
  if (const NodePtr limit = entry.find("torque_limit")) {
    settings.torque_limit = read_motor_values(limit, scene, kMoment, kForce, "the torque limit");
    for (const double value : settings.torque_limit)
      if (value <= 0) throw InputError("out_of_range", limit->place, "a torque limit that is not positive");
  }
  if (const NodePtr initial = entry.find("initial"))
    settings.initial_psi = read_motor_values(initial, scene, kPure, kLength, "the initial position");
  return settings;
}

}  // namespace mixloop
