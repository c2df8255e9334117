// SPDX-License-Identifier: MIT
#include "loop/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "controller/controller_keys.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/procedure/singular_mass.hpp"
#include "dynamics/scene/read_scene.hpp"
#include "loop/base.hpp"
#include "loop/energy_balance.hpp"
#include "loop/experiment_keys.hpp"
#include "loop/free_motion.hpp"
#include "loop/measured.hpp"
#include "notation/formula.hpp"
#include "notation/utf8.hpp"
#include "notation/value.hpp"
#include "notation/words.hpp"
#include "planner/path_keys.hpp"
#include "plant/hardware.hpp"
#include "plant/plant_keys.hpp"

namespace mixloop {
namespace {

/// `key: value` in YAML, applied to the document it belongs to.
NodePtr overridden(NodePtr document, const std::vector<Override>& overrides, bool of_scene) {
  static constexpr std::string_view kScene = "scene.";
  for (const auto& [key, value] : overrides) {
    if (key.starts_with(kScene) != of_scene) continue;
    document = override_entry(
        document, of_scene ? std::string_view(key).substr(kScene.size()) : std::string_view(key), value);
  }
  return document;
}

/// A scene's parameter keeps the dimension that its file gives it.
void check_parameter(const Node& scene, const NodePtr& changed, const std::string& name) {
  const NodePtr parameters = find_entry(scene, "parameters");
  const NodePtr before = parameters ? find_entry(*parameters, name) : nullptr;
  const NodePtr after = find_entry(*find_entry(*changed, "parameters"), name);
  if (!before || before->kind != Node::Kind::scalar) return;
  const std::string what = "the parameter '" + name + "'";
  number_of(*after, parse_formula(*before, what, Scope()).dimension, what);
}

/// A scene's document with overrides of its own entries.
NodePtr overridden_scene(const NodePtr& document, const std::vector<Override>& overrides, bool of_scene) {
  static constexpr std::string_view kParameters = "parameters.";
  const NodePtr changed = overridden(document, overrides, of_scene);
  for (const auto& [key, value] : overrides) {
    const std::string_view own =
        of_scene && key.starts_with("scene.") ? std::string_view(key).substr(6) : key;
    if (key.starts_with("scene.") == of_scene && own.starts_with(kParameters) &&
        own.find_first_of(".[", kParameters.size()) == std::string_view::npos)
      check_parameter(*document, changed, std::string(own.substr(kParameters.size())));
  }
  return changed;
}

NodePtr scene_document_at(const Node& node, const std::filesystem::path& base,
                          const std::vector<Override>& overrides) {
  const std::filesystem::path file = base / text_of(node, "the path of a scene file");
  std::error_code failure;
  if (!std::filesystem::exists(file, failure))
    throw InputError("no_such_file", node.place,
                     "no scene at " + describe(node) + " (its path counts from the experiment's folder)");
  return overridden_scene(read_document(file), overrides, true);
}

double read_rate(const Node& node) {
  const double rate = number_of(node, kFrequency, "the rate");
  if (!(rate >= 1 && rate <= 1e6))
    throw InputError("out_of_range", node.place,
                     fmt::format("a rate of {} Hz; expected 1 Hz to 1 MHz", rate));
  return rate;
}

/// A pair [least, most] for each motor.
std::vector<std::array<double, 2>> read_ranges(const NodePtr& node, const Scene& scene) {
  const auto pairs = items_of(node, "the position limits");
  if (pairs.size() != scene.motors().size() || node->kind != Node::Kind::sequence)
    throw InputError(
        "wrong_size", node->place,
        fmt::format("found {}; expected the position limits, a pair [least, most] for each of the {} motors",
                    describe(*node), scene.n_u()));
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& motor = scene.motors()[i];
    const auto pair = numbers_of(pairs[i], kPosition.of(motor), 2, "the limits [least, most]");
    if (!(pair[0] < pair[1]))
      throw InputError(
          "out_of_range", pairs[i]->place,
          fmt::format("the motor {} is to stay between {:g} and {:g} {}; expected the lower one first",
                      motor.name, pair[0], pair[1], position_unit(motor.linear)));
    ranges.push_back({pair[0], pair[1]});
  }
  return ranges;
}

void read_limits(const NodePtr& node, Experiment& experiment) {
  const Mapping entry = read_mapping(node, limit_keys());
  if (!experiment.has_path()) return refuse_limits(entry);
  const bool has_hand = experiment.scene->end_effector.named;
  if (const NodePtr limit = entry.find("position_error"); limit && !has_hand)
    throw InputError(
        "out_of_range", limit->place,
        "the scene names no end_effector, which limits.position_error is of; expected limits.motor_error");
  else if (limit)
    experiment.position_error_limit = number_of(*limit, kLength, "the position error limit");
  if (!(experiment.position_error_limit > 0))
    throw InputError("out_of_range", entry.at("position_error")->place,
                     "a position error limit that is not positive");
  const auto positive = [&](const char* key, const Quantity& quantity, const char* what) {
    const NodePtr limit = entry.find(key);
    if (!limit) return std::vector<double>();
    auto values = read_values(limit, experiment.scene->motors(), quantity, what);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!(values[i] > 0))
        throw InputError("out_of_range", items_of(limit, what)[i]->place,
                         fmt::format("{} is {:g}; expected more than 0", what, values[i]));
    return values;
  };
  experiment.limits.velocity = positive("velocity", kVelocity, "the velocity limit");
  experiment.limits.torque = positive("torque", kTorque, "the torque limit");
  if (const NodePtr limit = entry.find("motor_error"); limit && !experiment.path.is_of_motors())
    throw InputError(
        "out_of_range", limit->place,
        "limits.motor_error is of a path of the motors, and this one is of the end effector; expected "
        "limits.position_error");
  experiment.limits.motor_error = positive("motor_error", kPosition, "the motor error limit");
  if (const NodePtr limit = entry.find("position"))
    experiment.limits.position = read_ranges(limit, *experiment.scene);
}

Expectation read_expectation_of(const Experiment& experiment, const NodePtr& node) {
  std::optional<double> limit;
  if (experiment.has_path() && experiment.scene->end_effector.named) limit = experiment.position_error_limit;
  Expectation expect = read_expectation(node, *experiment.scene, limit, experiment.path.is_of_motors());
  if (const std::string why = other_work_in(experiment); expect.bounds_on("energy_drift") && !why.empty())
    throw InputError("out_of_range", find_entry(*node, "energy_drift")->place,
                     "energy and the motors' work don't balance: " + why +
                         "; expected a bound on energy_drift where nothing else does work");
  if (expect.safe_state && experiment.plant.continuous)
    throw InputError(
        "out_of_range", find_entry(*node, "safe_state")->place,
        "a safe state is real time's, which control: continuous has not; expected control: held");
  return expect;
}

/// Of each fault that is to come about: not after the last tick.
void require_faults_in_time(const Experiment& experiment, std::int64_t last_tick) {
  const NodePtr faults = experiment.document ? find_entry(*experiment.document, "faults") : nullptr;
  const auto& scheduled = experiment.plant.faults.scheduled;
  for (std::size_t i = 0; faults && i < std::min(scheduled.size(), faults->items.size()); ++i) {
    if (first_tick_at(scheduled[i].at, experiment.rate_hz) <= last_tick) continue;
    throw InputError(
        "out_of_range", find_entry(*faults->items[i], "at")->place,
        fmt::format(
            "a fault at {:g} s, after the run's end at {:g} s; expected an earlier one, or a longer {}",
            scheduled[i].at, static_cast<double>(last_tick) / experiment.rate_hz,
            experiment.has_path() ? "path" : "duration"));
  }
}

double read_duration(const Node& node) {
  const double seconds = number_of(node, kTime, "the duration");
  if (!(seconds > 0))
    throw InputError("out_of_range", node.place,
                     fmt::format("the duration is {} s; expected more than 0", seconds));
  return seconds;
}

void read_motion(const Mapping& root, Experiment& experiment) {
  if (const NodePtr path = root.find("path")) {
    experiment.path = read_path(path, *experiment.scene);
    return;
  }
  const NodePtr duration = root.at("duration");
  experiment.duration = read_duration(*duration);
  experiment.path.place = duration->place;
}

/// What controls a scene without a motor.
NodePtr nothing_to_control() {
  return parse_document("{law: torque, torque: []}", "the controller of no motors");
}

void read_faults_and_seed(const Mapping& root, Experiment& experiment) {
  PlantSettings& plant = experiment.plant;
  const NodePtr faults = root.find("faults");
  if (faults)
    plant.faults.scheduled = read_faults(faults, *experiment.scene,
                                         experiment.scene->has_friction() || plant.actuators.has_friction(),
                                         experiment.rate_hz, experiment.plant_parameters);
  if (const NodePtr seed = root.find("seed"))
    plant.seed = static_cast<std::uint64_t>(whole_number_of(*seed, 0, 1L << 53, "the seed"));
  for (const Fault& fault : plant.faults.scheduled)
    if (fault.target == Fault::Target::sensor &&
        std::ranges::count(plant.sensors.unmeasured, fault.index) > 0)
      throw InputError(
          "not_measured", faults->place,
          fmt::format("a fault of the sensor of '{}', which isn't measured (plant.sensors.free)",
                      experiment.scene->independent[static_cast<std::size_t>(fault.index)].name));
  check_hardware(plant, root.find("plant"), faults);
}

std::string text_of(const Path& path) {
  std::string text;
  for (const auto& via : path.vias) {
    text += fmt::format("{:a} {:a} {:a} {:a} {:a};", via.point.x(), via.point.y(), via.point.z(),
                        via.duration, via.dwell);
    for (const double motor : via.motors) text += fmt::format("motor {:a};", motor);
    if (!via.turns.isZero(0)) text += "turns " + joined("{:a}", {via.turns.data(), 3}, " ") + ";";
    if (via.direction) text += "direction " + joined("{:a}", {via.direction->data(), 3}, " ") + ";";
  }
  if (!path.held.empty()) text += "hold " + joined(path.held, " ") + ";";
  if (path.least_norm) text += "least norm;";
  return text + fmt::format("repeat {} approach {:a}", path.repeat, path.approach.value_or(0));
}

NodePtr parameters_in(const NodePtr& section) {
  return section ? find_entry(*section, "parameters") : nullptr;
}

}  // namespace

const Keys& limit_keys() {
  static const Keys keys{"the limits",
                         {{"position_error", form::number()},
                          {"motor_error", form::numbers()},
                          {"position", form::list(form::numbers())},
                          {"velocity", form::numbers()},
                          {"torque", form::numbers()}}};
  return keys;
}

const Keys& experiment_keys() {
  static const Keys keys{"the experiment",
                         {{"base", form::text()},
                          {"scene", form::text(), kRequired},
                          {"rate", form::number()},
                          {"path", form::mapping(path_keys)},
                          {"duration", form::number()},
                          {"controller", form::mapping(controller_keys)},
                          {"plant", form::mapping(plant_keys)},
                          {"real_time", form::mapping(real_time_keys)},
                          {"parameters", form::named(form::number())},
                          {"limits", form::mapping(limit_keys)},
                          {"expect", form::mapping(expectation_keys)},
                          {"faults", form::list(form::mapping(fault_keys))},
                          {"seed", form::whole()},
                          {"cases", form::named(form::any())}},
                         "base",
                         {"path", "duration"}};
  return keys;
}

Override parse_override(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("invalid_override", {"--set " + text},
                     "expected key=value, e.g. --set parameters.payload='3 kg'");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Experiment load_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return load_experiment(read_document(file), file, overrides);
}

Experiment load_experiment(const NodePtr& document, const std::filesystem::path& file,
                           const std::vector<Override>& overrides) {
  const NodePtr whole = experiment_document(document, file, overrides);
  return read_experiment(whole, file, load_scenes(whole, file, overrides));
}

NodePtr experiment_document(const NodePtr& document, const std::filesystem::path& file,
                            const std::vector<Override>& overrides) {
  return overridden(on_base(document, file), overrides, false);
}

ExperimentScenes load_scenes(const NodePtr& document, const std::filesystem::path& file,
                             const std::vector<Override>& overrides) {
  const Mapping root = read_mapping(document, experiment_keys());
  const auto base = file.parent_path();
  ExperimentScenes scenes{.document = scene_document_at(*root.at("scene"), base, overrides)};
  scenes.scene = scenes.controller_scene = std::make_shared<const Scene>(load_scene(scenes.document));
  const NodePtr controller = root.find("controller");
  if (const NodePtr other = controller ? find_entry(*controller, "scene") : nullptr) {
    scenes.controller_scene = std::make_shared<const Scene>(load_scene(scene_document_at(*other, base, {})));
    require_same_motors(*scenes.controller_scene, *scenes.scene, other->place);
  }
  return scenes;
}

Experiment read_experiment(const NodePtr& document, const std::filesystem::path& file,
                           const ExperimentScenes& scenes) {
  Experiment experiment;
  experiment.document = document;
  const Mapping root = read_mapping(document, experiment_keys());
  experiment.file = file;
  experiment.name = printable_name(file.stem().string());
  experiment.scene_document = scenes.document;
  experiment.scene = scenes.scene;
  experiment.controller_scene = scenes.controller_scene;
  const Scene& scene = *experiment.scene;
  if (const NodePtr rate = root.find("rate")) experiment.rate_hz = read_rate(*rate);
  read_motion(root, experiment);

  const NodePtr controller =
      scene.n_u() > 0 || root.has("controller") ? root.at("controller") : nothing_to_control();
  experiment.controller = read_controller_settings(controller, scene, file.parent_path());
  const NodePtr plant = root.find("plant");
  if (plant) experiment.plant = read_plant_settings(plant, scene, experiment.rate_hz);
  if (const NodePtr real_time = root.find("real_time"))
    experiment.deadline = read_deadline_settings(real_time);
  settle_safe_state(root, experiment);
  check_motion(experiment, controller, plant);
  require_measured(experiment, controller);
  if (experiment.plant.continuous && !experiment.controller.safety.torque_rate_limit.empty())
    throw InputError(
        "out_of_range", find_entry(*controller, "safety")->place,
        "a torque_rate_limit is from command to command, which control: continuous has not; expected "
        "control: held");
  experiment.parameters = parameter_values(scene, root.find("parameters"), scene.default_parameters());
  experiment.plant_parameters = parameter_values(scene, parameters_in(plant), experiment.parameters);
  experiment.controller_parameters = parameter_values(*experiment.controller_scene, parameters_in(controller),
                                                      experiment.controller_scene != experiment.scene
                                                          ? experiment.controller_scene->default_parameters()
                                                          : experiment.parameters);
  require_inertia(experiment.scene, experiment.plant_parameters);
  read_faults_and_seed(root, experiment);
  if (const NodePtr limits = root.find("limits")) read_limits(limits, experiment);
  if (const NodePtr expect = root.find("expect")) experiment.expect = read_expectation_of(experiment, expect);
  return experiment;
}

Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return load_scene(read_document(file), overrides);
}

Scene load_scene(const NodePtr& document, const std::vector<Override>& overrides) {
  return load_scene(overridden_scene(document, overrides, false));
}

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return read_scene(overridden_scene(read_document(file), overrides, false));
}

void require_faults_in_time(const Experiment& experiment, const Plan& plan) {
  require_faults_in_time(experiment, plan.ticks());
}

std::shared_ptr<const Equations> equations_for(const Experiment& experiment,
                                               const std::shared_ptr<const Scene>& scene,
                                               const std::vector<Purpose>& purposes,
                                               Equations::Options options) {
  return shelved_equations(experiment.shelf.get(), scene, experiment.evaluation, purposes, options);
}

Plan make_plan(const Experiment& experiment) {
  if (!experiment.has_path()) {
    Plan plan = plan_without_path(experiment);
    require_faults_in_time(experiment, plan);
    return plan;
  }
  const auto model = make_model<double>(experiment.scene, std::span<const double>(experiment.parameters));
  Plan::Settings settings{
      .rate_hz = experiment.rate_hz, .limits = experiment.limits, .start_psi = experiment.plant.initial_psi};
  if (!settings.start_psi.empty()) settings.start_psi.resize(experiment.scene->motors().size());
  if (experiment.plant.continuous) {
    const StageRows rows = stage_rows(experiment.plant.integrator);
    settings.stages_per_tick = experiment.plant.substeps * (rows.uniform ? rows.rows : 1);
    if (!rows.uniform) settings.within = rows.at;
  }
  Plan plan(model, experiment.path, settings);
  require_faults_in_time(experiment, plan);
  return plan;
}

Controller make_controller(const Experiment& experiment) {
  const auto& scene = experiment.controller_scene;
  const auto equations = has_gains(experiment.controller.law)
                             ? equations_for(experiment, scene, {Purpose::mass_times, Purpose::bias})
                             : equations_for(experiment, scene, {});
  return Controller({equations, experiment.controller_parameters}, experiment.controller,
                    seen_coordinates(experiment));
}

GuardedController make_guarded_controller(const Experiment& experiment) {
  return GuardedController(make_controller(experiment), experiment.controller.safety,
                           experiment.controller.kv);
}

Experiment with_integrator_settled(Experiment experiment, const Plan& plan) {
  if (!experiment.plant.automatic || experiment.integrator_choice) return experiment;
  PlantProbe probe(experiment.scene, experiment.plant_parameters, experiment.plant.actuators,
                   Evaluation::machine_code);
  const IntegratorChoice choice = choose_integrator(
      probe, plan, {experiment.rate_hz, experiment.plant.local_error, !experiment.plant.actuators.any()});
  experiment.plant.integrator = choice.method;
  experiment.plant.substeps = choice.substeps;
  experiment.plant.local_error = 0;  // the steps are settled
  experiment.integrator_choice = choice;
  return experiment;
}

Plant make_plant(const Experiment& experiment, const Plan& plan) {
  if (experiment.plant.automatic && !experiment.integrator_choice)
    return make_plant(with_integrator_settled(experiment, plan), plan);
  Vector start = map_of(start_of(experiment));
  if (plan.has_path()) start.head(plan.n_u()) = plan.at(0).psi;
  PlantSettings settings = experiment.plant;
  settings.parameters = experiment.plant_parameters;
  Equations::Workspace dynamics(
      plant_equations(experiment.scene, experiment.evaluation, settings, experiment.shelf.get()),
      experiment.plant_parameters);
  return Plant(std::move(dynamics), settings, experiment.rate_hz, span_of(std::as_const(start)),
               settings.initial_psid);
}

DeadlinePlant make_deadline_plant(const Experiment& experiment, const Plan& plan) {
  return DeadlinePlant(make_plant(experiment, plan), experiment.plant, experiment.deadline,
                       experiment.rate_hz, plan.ticks());
}

std::array<std::string, 4> common_ground(const Experiment& experiment) {
  std::string path, parameters;
  if (!experiment.has_path()) {
    path = fmt::format("duration {:a} rates", *experiment.duration);
    for (const double rate : experiment.plant.initial_psid) path += fmt::format(" {:a}", rate);
  } else {
    path = text_of(experiment.path);
  }
  for (const double limit : experiment.limits.velocity) path += fmt::format(" {:a}", limit);
  path += " from";
  for (const double psi : experiment.plant.initial_psi) path += fmt::format(" {:a}", psi);
  for (const double value : experiment.parameters) parameters += fmt::format("{:a} ", value);
  std::string mechanism = experiment.scene->canonical;
  for (const int i : experiment.plant.sensors.unmeasured) mechanism += fmt::format(" unmeasured {}", i);
  return {fmt::format("{:a}", experiment.rate_hz), mechanism, path, parameters};
}

}  // namespace mixloop
