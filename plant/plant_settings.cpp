// SPDX-License-Identifier: MIT
#include "plant/plant_settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/value.hpp"
#include "notation/words.hpp"
#include "plant/plant_keys.hpp"

namespace mixloop {

namespace {

constexpr double kLocalError = 1e-9;  // what `auto` keeps unless told

std::vector<std::string> integrator_words() {
  auto words = method_names();
  words.emplace_back("auto");
  return words;
}

void read_integrator(const Mapping& entry, PlantSettings& settings) {
  const NodePtr integrator = entry.find("integrator"), substeps = entry.find("substeps"),
                local_error = entry.find("local_error");
  if (integrator) {
    const auto& words = words_of(plant_keys(), "integrator");
    const auto word = std::find(words.begin(), words.end(), text_of(*integrator, "the integrator"));
    if (word == words.end())
      throw InputError(
          "unknown_value", integrator->place,
          fmt::format("the integrator is {}; expected one of {}", describe(*integrator), joined(words)));
    settings.automatic = *word == "auto";
    if (!settings.automatic) settings.integrator = static_cast<Method>(word - words.begin());
  }
  if (substeps) settings.substeps = static_cast<int>(whole_number_of(*substeps, 1, 1000, "substeps"));
  if (settings.automatic) settings.local_error = kLocalError;
  if (settings.substeps > 1 && (local_error || settings.automatic))
    throw InputError("doubly_defined", substeps->place,
                     local_error
                         ? "substeps and local_error both say how long steps are; expected one of them"
                         : "integrator: auto finds the substeps itself; expected a local_error or nothing");
  if (!local_error) return;
  settings.local_error = number_of(*local_error, kPure, "the local error");
  if (!(settings.local_error >= 1e-14 && settings.local_error <= 0.1))
    throw InputError("out_of_range", local_error->place,
                     fmt::format("a local error of {}; expected 1e-14 to 0.1", settings.local_error));
  if (!settings.automatic && !facts(settings.integrator).error_control)
    throw InputError(
        "out_of_range", local_error->place,
        fmt::format("{} has no estimate of its error; expected substeps, or dormand_prince, dop853 or auto "
                    "as the integrator",
                    facts(settings.integrator).name));
}

/// What can't evaluate the control at its stages.
void require_stages_in_time(const PlantSettings& settings, const Place& place) {
  if (settings.automatic)
    throw InputError(
        "out_of_range", place,
        "integrator: auto looks at ticks with the torque held; with control: continuous name one");
  if (facts(settings.integrator).jacobian)
    throw InputError(
        "out_of_range", place,
        fmt::format("{} takes the Jacobian of the plant, which has not the controller's share of control: "
                    "continuous; expected another integrator or control: held",
                    facts(settings.integrator).name));
  if (settings.local_error > 0)
    throw InputError(
        "out_of_range", place,
        "a local_error chooses steps as it goes, and with control: continuous the references stand at "
        "fixed stages; expected substeps");
}

/// Whether to switch coordinates, and to which.
void read_near_singular(const Mapping& entry, const Scene& scene, PlantSettings& settings) {
  const NodePtr said = entry.find("near_singular");
  if (!said) return;
  const bool switches = word_of(*said, words_of(plant_keys(), "near_singular"), "near_singular") == 1;
  if (!scene.is_closed())
    throw InputError("out_of_range", said->place,
                     "near_singular is of closures that are solved as the mechanism moves, and the scene has "
                     "none; expected it left out");
  if (!switches) return;
  if (settings.automatic || facts(settings.integrator).jacobian)
    throw InputError(
        "out_of_range", said->place,
        fmt::format(
            "{} takes the linearisation in the declared coordinates, and near_singular: switch leaves "
            "them; expected an integrator without a Jacobian, or near_singular: stop",
            settings.automatic ? "integrator: auto" : facts(settings.integrator).name));
  auto partitions = partitions_of(scene);
  if (partitions.size() == 1)
    throw InputError("out_of_range", said->place,
                     "the closures leave no other coordinates to switch to: in none of their unknowns in a "
                     "motor's place can the mechanism be put together; expected near_singular: stop");
  settings.partitions = std::make_shared<const std::vector<Partition>>(std::move(partitions));
}

}  // namespace

const Keys& plant_keys() {
  static const Keys keys{"the plant",
                         {{"integrator", form::word(integrator_words())},
                          {"local_error", form::number()},
                          {"control", form::word({"held", "continuous"})},
                          {"substeps", form::whole()},
                          {"command_delay", form::number()},
                          {"torque_limit", form::numbers()},
                          {"initial", form::numbers()},
                          {"initial_rates", form::numbers()},
                          {"near_singular", form::word({"stop", "switch"})},
                          {"parameters", form::named(form::number())},
                          {"sensors", form::mapping(sensor_keys)},
                          {"actuators", form::mapping(actuator_keys)}}};
  return keys;
}

PlantSettings read_plant_settings(const NodePtr& node, const Scene& scene, double rate_hz) {
  const Mapping entry = read_mapping(node, plant_keys());
  PlantSettings settings;
  read_integrator(entry, settings);
  if (const NodePtr control = entry.find("control"))
    settings.continuous = word_of(*control, words_of(plant_keys(), "control"), "control") == 1;
  if (settings.continuous) require_stages_in_time(settings, entry.at("control")->place);
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
    settings.torque_limit = read_values(limit, scene.motors(), kTorque, "the torque limit");
    for (const double value : settings.torque_limit)
      if (value <= 0) throw InputError("out_of_range", limit->place, "a torque limit that is not positive");
  }
  if (const NodePtr initial = entry.find("initial"))
    settings.initial_psi = read_values(initial, scene.independent, kPosition, "the initial position");
  if (const NodePtr rates = entry.find("initial_rates"))
    settings.initial_psid = read_values(rates, scene.independent, kVelocity, "the initial rate");
  read_near_singular(entry, scene, settings);
  if (const NodePtr sensors = entry.find("sensors"))
    settings.sensors = read_sensor_settings(sensors, scene, rate_hz);
  if (const NodePtr actuators = entry.find("actuators"))
    settings.actuators = read_actuator_settings(actuators, scene);
  return settings;
}

std::vector<double> parameters_of(const PlantSettings& settings, const Scene& scene) {
  return settings.parameters.empty() ? scene.default_parameters() : settings.parameters;
}

PlantSettings ideal(PlantSettings settings) {
  settings.sensors = {};
  settings.actuators = {};
  settings.faults = {};
  return settings;
}

}  // namespace mixloop
