// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "controller/guarded_controller.hpp"
#include "dynamics/equations_shelf.hpp"
#include "loop/expectation.hpp"
#include "loop/integrator_choice.hpp"
#include "planner/plan.hpp"
#include "plant/deadline_plant.hpp"

namespace mixloop {

/// A `--set key=value`.
struct Override {
  std::string key;
  std::string value;
};

/// Splits `key=value`; throws InputError where there is no `=`.
Override parse_override(const std::string& text);

/// What to run with a scene; docs/experiments.md describes the file. The three processes read the same one.
struct Experiment {
  std::string name;  ///< the file's stem
  std::filesystem::path file;
  NodePtr document, scene_document;               ///< as read, overrides applied: what a result is kept with
  std::shared_ptr<const Scene> scene;             ///< of the plant and the planner
  std::shared_ptr<const Scene> controller_scene;  ///< what the controller takes the robot for
  double rate_hz = 1000;
  Path path;                       ///< where there is none, but for its place: that of the duration
  std::optional<double> duration;  ///< s: of a motion without a path
  ControllerSettings controller;
  PlantSettings plant;
  DeadlineSettings deadline;       ///< in real time
  std::vector<double> parameters;  ///< shared
  std::vector<double> plant_parameters;
  std::vector<double> controller_parameters;
  double position_error_limit = 0.1;                  ///< m: past it the run has diverged
  std::optional<IntegratorChoice> integrator_choice;  ///< of `integrator: auto`, once settled
  PlanLimits limits;
  Expectation expect;
  Evaluation evaluation = Evaluation::machine_code;  ///< of the equations of motion, everywhere
  /// From which those that share it have their equations; none: each makes its own.
  std::shared_ptr<EquationsShelf> shelf;

  bool has_path() const { return !duration; }
};

/// Equations of one of its scenes, evaluated as it says.
std::shared_ptr<const Equations> equations_for(const Experiment& experiment,
                                               const std::shared_ptr<const Scene>& scene,
                                               const std::vector<Purpose>& purposes,
                                               Equations::Options options = {});

/// Reads an experiment with overrides on top (`scene.` before an entry of the scene's own). Throws
/// InputError.
Experiment load_experiment(const std::filesystem::path& file, const std::vector<Override>& overrides);
Experiment load_experiment(const NodePtr& document, const std::filesystem::path& file,
                           const std::vector<Override>& overrides);

/// The scenes of an experiment, for all experiments that differ in other entries alone.
struct ExperimentScenes {
  NodePtr document;  ///< as read, overrides applied
  std::shared_ptr<const Scene> scene, controller_scene;
};

/// load_experiment in its three parts: the document on its base, overrides applied; its scenes; the rest.
NodePtr experiment_document(const NodePtr& document, const std::filesystem::path& file,
                            const std::vector<Override>& overrides);
ExperimentScenes load_scenes(const NodePtr& document, const std::filesystem::path& file,
                             const std::vector<Override>& overrides);
Experiment read_experiment(const NodePtr& document, const std::filesystem::path& file,
                           const ExperimentScenes& scenes);

/// A scene file with overrides of its entries; `parameters.NAME` sets a default.
Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides);
Scene load_scene(const NodePtr& document, const std::vector<Override>& overrides);
/// The same, not put together (dynamics/scene/read_scene.hpp).
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides);

/// The parts of the loop. make_plan checks the whole path first and throws InputError where it can't be run,
/// or where a fault comes after its end. Without a path the motors' reference at every tick is where the
/// plant starts, at rest, or what `state_feedback` feeds back about.
Plan make_plan(const Experiment& experiment);
/// The second of these, for a plan that was made for another experiment.
void require_faults_in_time(const Experiment& experiment, const Plan& plan);
Controller make_controller(const Experiment& experiment);
GuardedController make_guarded_controller(const Experiment& experiment);
Plant make_plant(const Experiment& experiment, const Plan& plan);
DeadlinePlant make_deadline_plant(const Experiment& experiment, const Plan& plan);

/// The experiment with `integrator: auto` settled; as it is where one is named.
Experiment with_integrator_settled(Experiment experiment, const Plan& plan);

/// What plant, controller and planner must have in common, a text each to hash: rate, mechanism, path and
/// shared parameters (the order of ConfigHash).
std::array<std::string, 4> common_ground(const Experiment& experiment);

}  // namespace mixloop
