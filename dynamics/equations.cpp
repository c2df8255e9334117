// SPDX-License-Identifier: MIT
#include "dynamics/equations.hpp"

#include <algorithm>
#include <optional>

#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/program.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "dynamics/scene/canonical.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

std::shared_ptr<const Scene> with_friction_factor(const Scene& scene) {
  auto scaled = std::make_shared<Scene>(scene);
  scaled->friction_factor = true;
  scaled->canonical = canonical_text(*scaled);
  return scaled;
}

}  // namespace

Equations::Equations(std::shared_ptr<const Scene> scene, Evaluation how, std::span<const Purpose> purposes,
                     Options options)
    : scene_(std::move(scene)), evaluation_(how) {
  const auto scaled =
      options.friction_factor && scene_->has_friction() ? with_friction_factor(*scene_) : nullptr;
  for (Purpose purpose : purposes) {
    const auto at = static_cast<std::size_t>(purpose);
    plain_[at] = routine(scene_, purpose, how, options);
    if (scaled && signature(purpose).has_forces) scaled_[at] = routine(scaled, purpose, how, options);
  }
  if (scene_->is_closed()) closures_ = of_closures(how);
}

std::unique_ptr<const Routine> Equations::routine(const std::shared_ptr<const Scene>& scene, Purpose purpose,
                                                  Evaluation how, Options options) {
  if (how == Evaluation::reference) return reference_routine(scene, purpose);
  // Where chains close, what solves them stands behind all outputs.
  const bool position = options.position_alone && purpose == Purpose::end_effector && !scene->is_closed();
  const auto program = [&] {
    Program whole = trace(scene, purpose).program;
    return position && !whole.outputs.empty() ? first_outputs(whole, 3) : whole;
  };
  std::optional<int> steps_of;
  if (purpose == Purpose::forward_dynamics && !scene->is_closed()) steps_of = scene->n_u();
  auto found = made(std::string(position ? "position" : name_of(purpose)) + "\n" + scene->canonical, program,
                    how, steps_of);
  if (found) return found;
  evaluation_ = Evaluation::reference;
  return reference_routine(scene, purpose);
}

// The procedure itself has no program of it.
std::unique_ptr<const Routine> Equations::of_closures(Evaluation how) {
  auto found = made(
      "closures\n" + scene_->canonical, [&] { return trace_closures(scene_); },
      std::max(how, Evaluation::interpreter));
  if (!found)
    throw InputError("too_large", {scene_->name},
                     "what its closures are solved by takes more operations than a program may; expected "
                     "fewer closures");
  return found;
}

std::unique_ptr<const Routine> Equations::made(const std::string& key, const std::function<Program()>& trace,
                                               Evaluation how, std::optional<int> steps_of) {
  std::optional<Program> traced;
  const auto program = [&] {
    if (!traced) traced = trace();
    return *traced;
  };
  if (how == Evaluation::machine_code) {
    std::string complaint;
    if (auto code = MachineCode::load(key, program, complaint, steps_of)) return code;
    if (complaint_.empty()) complaint_ = complaint;
  }
  if (program().outputs.empty()) return nullptr;
  evaluation_ = std::min(evaluation_, Evaluation::interpreter);
  return std::make_unique<Interpreter>(program());
}

std::shared_ptr<const Equations> equations_of(std::shared_ptr<const Scene> scene, Evaluation how,
                                              const std::vector<Purpose>& purposes,
                                              Equations::Options options) {
  return std::make_shared<const Equations>(std::move(scene), how, purposes, options);
}

Equations::Workspace::Workspace(std::shared_ptr<const Equations> equations,
                                std::span<const double> parameters)
    : equations_(std::move(equations)), values_(parameters.size() + 1) {
  for (std::size_t i = 0; i < serving_.size(); ++i) {
    if (equations_->plain_[i]) serving_[i] = Evaluator(*equations_->plain_[i]);
    if (equations_->scaled_[i]) resting_[i] = Evaluator(*equations_->scaled_[i]);
  }
  if (equations_->closures_) follower_ = ClosureFollower(equations_->scene_, *equations_->closures_);
  set_parameters(parameters);
  if (follower_) follower_.set_parameters(values_);
}

void Equations::Workspace::set_parameters(std::span<const double> parameters, double friction) noexcept {
  std::copy(parameters.begin(), parameters.end(), values_.begin());
  values_.back() = friction;
  if (scaled_ != (friction != 1)) {
    scaled_ = !scaled_;
    for (std::size_t i = 0; i < serving_.size(); ++i)
      if (resting_[i]) std::swap(serving_[i], resting_[i]);
  }
  for (Evaluator& evaluator : serving_)
    if (evaluator) evaluator.set_up(values_);
  if (follower_) follower_.change_parameters(values_);
}

}  // namespace mixloop
