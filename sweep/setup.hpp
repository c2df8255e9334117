// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "sweep/request.hpp"

namespace mixloop {

/// A run that is ready to go: its experiment, the integrator settled, and the plan, which others may have
/// too.
struct PreparedRun {
  std::int64_t run = 0;
  Experiment experiment;
  std::shared_ptr<const Plan> plan;
};

/// What the runs of a sweep have in common, worked out once: files read, scenes put together, programs, plans
/// and their inverse kinematics, as far as nothing that they depend on is varied. Threads share it.
class Setup {
 public:
  /// Reads the experiment, and holds that the varied keys are entries of it. Throws InputError.
  Setup(const SweepRequest& request, Evaluation evaluation);

  const SweepRequest& request() const { return request_; }
  const Design& design() const { return design_; }
  /// As it is before anything is varied.
  const Experiment& experiment() const { return *experiment_; }

  /// The experiment that `mixloop simulate` would run, to the bit. Throws InputError where it can't be run.
  PreparedRun prepared(std::int64_t run) const { return prepared(run, design_.overrides(run)); }
  /// The same with other values of what is varied; `run` is what it is called.
  PreparedRun prepared(std::int64_t run, const std::vector<Override>& values) const;
  /// Its document, and those of its scenes, which are put together for it where they are varied.
  NodePtr document(const std::vector<Override>& values) const;
  ExperimentScenes scenes(const std::vector<Override>& values, const NodePtr& document) const;

  bool varies_scene() const { return varies_scene_; }
  /// How the equations are evaluated: of scenes that vary by the interpreter, whose bits are the same, since
  /// none is used long enough to be worth compiling.
  Evaluation evaluation() const { return evaluation_; }

 private:
  std::shared_ptr<const Plan> plan_of(const Experiment& experiment) const;

  SweepRequest request_;
  Design design_;
  NodePtr document_;  ///< on its base, the overrides of all runs applied
  ExperimentScenes scenes_;
  bool varies_scene_, varies_controller_scene_;
  Evaluation evaluation_;
  std::shared_ptr<EquationsShelf> shelf_ = std::make_shared<EquationsShelf>();
  std::unique_ptr<const Experiment> experiment_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<const Plan>> plans_;  ///< a few, by what they depend on
};

}  // namespace mixloop
