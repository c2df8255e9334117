// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/closure_follower.hpp"
#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/evaluation.hpp"
#include "dynamics/program/routine.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

struct Program;

/// A scene's equations of motion, ready to evaluate for the purposes asked for. Constant: threads share them,
/// each with a Workspace of its own.
class Equations {
 public:
  class Workspace;
  struct Options {
    bool friction_factor = false;  ///< viscous friction is to be scaled by Workspace::set_parameters
    bool position_alone = false;   ///< of the end effector nothing else is asked; the rest is left as it was

    auto operator<=>(const Options&) const = default;
  };

  /// Traces (and compiles, or finds compiled) the programs. Throws InputError for a scene whose constraints
  /// cannot be evaluated, and "too_large" for a linearisation that takes too many operations.
  Equations(std::shared_ptr<const Scene> scene, Evaluation how, std::span<const Purpose> purposes,
            Options options);

  const Scene& scene() const { return *scene_; }
  /// What serves: of several purposes the slowest way that one of them is evaluated.
  Evaluation evaluation() const { return evaluation_; }
  /// Why programs are interpreted that should have been compiled; empty where none is, or is but too long.
  const std::string& complaint() const { return complaint_; }

 private:
  using Routines = std::array<std::unique_ptr<const Routine>, kPurposes.size()>;

  std::unique_ptr<const Routine> routine(const std::shared_ptr<const Scene>& scene, Purpose purpose,
                                         Evaluation how, Options options);
  std::unique_ptr<const Routine> of_closures(Evaluation how);
  /// Of a key and what it stands for; nothing for a program that is too long to trace.
  std::unique_ptr<const Routine> made(const std::string& key, const std::function<Program()>& program,
                                      Evaluation how, std::optional<int> steps_of = {});

  std::shared_ptr<const Scene> scene_;
  Evaluation evaluation_;
  std::string complaint_;
  Routines plain_, scaled_;  ///< of the scene as it stands, and with its friction times a factor
  std::unique_ptr<const Routine> closures_;  ///< where chains close
};

/// The same, to be shared.
std::shared_ptr<const Equations> equations_of(std::shared_ptr<const Scene> scene, Evaluation how,
                                              const std::vector<Purpose>& purposes,
                                              Equations::Options options = {});

/// What evaluations need beside the equations, for the parameters' values in force. One thread at a time uses
/// it; a copy is another.
class Equations::Workspace {
 public:
  Workspace(std::shared_ptr<const Equations> equations, std::span<const double> parameters);

  const Equations& equations() const { return *equations_; }
  const Scene& scene() const { return equations_->scene(); }
  /// As many numbers as a purpose gives.
  std::vector<double> outputs(Purpose purpose) const {
    return std::vector<double>(output_size(purpose, scene().n(), scene().n_u()));
  }

  /// Runs the set-up programs: new values for the scene's parameters, and a factor on its viscous friction,
  /// which equations without that option don't know. Where it is 1, the bits are those of equations without.
  void set_parameters(std::span<const double> parameters, double friction = 1) noexcept;

  /// Evaluates a purpose that was asked for. Spans are as long as its signature says, in SI units; outputs
  /// may not overlap inputs. Doesn't allocate, lock, print or throw.
  ///
  /// Where chains close and are solved by corrections, from the anchor: the pose that was accepted last, at
  /// first home. Poses far from it are accepted on the way, unless `hold_anchor`.
  Status evaluate(Purpose purpose, const Arguments& at, std::span<double> outputs) noexcept {
    Evaluator& evaluator = serving_[static_cast<std::size_t>(purpose)];
    if (!follower_ || evaluator.solves_itself()) return evaluator.evaluate(at, outputs);
    const auto takes = static_cast<std::size_t>(signature(purpose).input_size(scene().n(), scene().n_u()));
    return follower_.evaluate(evaluator, at, takes, outputs, !holds_anchor_);
  }

  /// Whether forward dynamics come as whole steps of this method, too: as machine code, of up to three
  /// motors, where no chain closes.
  bool has_steps(StepsBy method) const {
    return serving_[static_cast<std::size_t>(Purpose::forward_dynamics)].has_steps(method);
  }
  /// The bits of the method on evaluations: x = psi, psi', n each, and the work of `tau`, which is held, goes
  /// on by `steps` steps of h s from t on.
  void go_on(StepsBy method, std::span<double> x, std::span<const double> tau, double t, double h,
             int steps) noexcept {
    serving_[static_cast<std::size_t>(Purpose::forward_dynamics)].go_on(method, x, tau, t, h, steps);
  }

  /// From now on the anchor moves by `closures().accept` alone: whoever takes steps that may be rejected says
  /// which counts.
  void hold_anchor() { holds_anchor_ = true; }
  /// What is watched of the closures, and where they are solved from; false where no chain closes.
  ClosureFollower& closures() { return follower_; }
  const ClosureFollower& closures() const { return follower_; }

 private:
  using Evaluators = std::array<Evaluator, kPurposes.size()>;

  std::shared_ptr<const Equations> equations_;
  std::vector<double> values_;    ///< the parameters', then the factor
  Evaluators serving_, resting_;  ///< where there is a factor: with it and without, as it is 1 or not
  bool scaled_ = false;           ///< those with it serve
  ClosureFollower follower_;
  bool holds_anchor_ = false;
};

}  // namespace mixloop
