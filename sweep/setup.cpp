// SPDX-License-Identifier: MIT
#include "sweep/setup.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plant/faults.hpp"
#include "sweep/key.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kMostPlans = 16;

/// All that a plan of these scenes depends on.
std::string ground_of_plan(const Experiment& experiment) {
  const auto common = common_ground(experiment);
  std::string text = common[0] + common[2] + " torque";
  for (const double limit : experiment.limits.torque) text += fmt::format(" {:a}", limit);
  const PlantSettings& plant = experiment.plant;
  if (plant.continuous) text += fmt::format(" stages {} {}", facts(plant.integrator).name, plant.substeps);
  text += " parameters";
  for (std::size_t i = 0; i < experiment.parameters.size(); ++i)
    if (!experiment.limits.torque.empty() || !may_change(*experiment.scene, static_cast<int>(i)))
      text += fmt::format(" {:a}", experiment.parameters[i]);
  return text;
}

bool within(const std::string& key, std::string_view of) {
  return key == of || (key.starts_with(of) && (key[of.size()] == '.' || key[of.size()] == '['));
}

}  // namespace

Setup::Setup(const SweepRequest& request, Evaluation evaluation)
    : request_(request), design_(request.design), evaluation_(evaluation) {
  require_samples(request);
  const auto& varied = design_.variations();
  const auto any = [&](const auto& is) {
    return std::ranges::any_of(varied, [&](const Variation& one) { return is(one.key); });
  };
  varies_scene_ = any([](const std::string& key) { return is_of_scene(key) || within(key, "scene"); });
  varies_controller_scene_ = any([](const std::string& key) { return within(key, "controller.scene"); });
  document_ = experiment_document(read_document(request.experiment), request.experiment, request.overrides);
  scenes_ = load_scenes(document_, request.experiment, request.overrides);
  for (const Variation& one : varied) require_key(one, document_, scenes_);
  if (varies_scene_ || varies_controller_scene_) evaluation_ = std::min(evaluation_, Evaluation::interpreter);
  auto experiment = std::make_unique<Experiment>(read_experiment(document_, request.experiment, scenes_));
  experiment->evaluation = evaluation_;
  experiment->shelf = shelf_;
  experiment_ = std::move(experiment);
}

NodePtr Setup::document(std::int64_t run) const {
  NodePtr document = document_;
  for (const auto& [key, value] : design_.overrides(run))
    if (!is_of_scene(key)) document = override_entry(document, key, value);
  return document;
}

ExperimentScenes Setup::scenes(std::int64_t run, const NodePtr& document) const {
  if (!varies_scene_ && !varies_controller_scene_) return scenes_;
  std::vector<Override> overrides = request_.overrides;
  for (auto& one : design_.overrides(run)) overrides.push_back(std::move(one));
  return load_scenes(document, request_.experiment, overrides);
}

std::shared_ptr<const Plan> Setup::plan_of(const Experiment& experiment) const {
  if (experiment.scene != scenes_.scene || !experiment.has_path())
    return std::make_shared<const Plan>(make_plan(experiment));
  const std::string ground = ground_of_plan(experiment);
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = plans_.find(ground); known != plans_.end()) {
      require_faults_in_time(experiment, *known->second);
      return known->second;
    }
  }
  auto plan = std::make_shared<const Plan>(make_plan(experiment));
  const std::lock_guard lock(mutex_);
  if (plans_.size() == kMostPlans) plans_.clear();
  return plans_.emplace(ground, std::move(plan)).first->second;
}

PreparedRun Setup::prepared(std::int64_t run) const {
  const NodePtr document = this->document(run);
  PreparedRun prepared{.run = run,
                       .experiment = read_experiment(document, request_.experiment, scenes(run, document))};
  Experiment& experiment = prepared.experiment;
  experiment.evaluation = evaluation_;
  if (experiment.scene == scenes_.scene && experiment.controller_scene == scenes_.controller_scene)
    experiment.shelf = shelf_;
  prepared.plan = plan_of(experiment);
  if (experiment.plant.automatic) experiment = with_integrator_settled(std::move(experiment), *prepared.plan);
  return prepared;
}

}  // namespace mixloop
