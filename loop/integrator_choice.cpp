// SPDX-License-Identifier: MIT
#include "loop/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "dynamics/program/trace.hpp"
#include "loop/step_fitness.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kMostPoses = 48;
constexpr double kOwnMotion =
    1e-3;  // of its amplitude: what of the plant's own motion may be lost within a run

/// What methods add in a tick from some poses, beside DOP853 under error control.
class LocalErrors {
 public:
  LocalErrors(PlantProbe& probe, const std::vector<PlantPose>& poses, const ChoiceTask& task)
      : probe_(probe), poses_(poses), tick_(1 / task.rate_hz), asked_(task.local_error) {
    const double finest = std::max(1e-15, asked_ * 1e-3);
    Integrator reference({Method::dop853, 1, finest}, n(), 2 * n());
    for (const PlantPose& pose : poses_) ends_.push_back(probe_.advanced(reference, pose, tick_));
  }

  /// The largest; of those beyond what is asked the first.
  LocalError largest(const IntegratorSettings& steps) {
    Integrator integrator(steps, n(), 2 * n());
    LocalError largest;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const Vector end = probe_.advanced(integrator, poses_[i], tick_);
      const double error = error_size<double>(end - ends_[i], poses_[i].x, n());
      if (!(error <= largest.error)) largest = {error, poses_[i].t};
      if (!(largest.error <= asked_)) break;
    }
    return largest;
  }

 private:
  Eigen::Index n() const { return probe_.scene().n(); }

  PlantProbe& probe_;
  const std::vector<PlantPose>& poses_;
  double tick_, asked_;
  std::vector<Vector> ends_;
};

/// Of a Jacobian, in evaluations of the forward dynamics; infinite where one is too long for a program.
double jacobian_cost(const std::shared_ptr<const Scene>& scene) {
  const Program dynamics = trace(scene, Purpose::forward_dynamics).program;
  if (dynamics.outputs.empty()) return std::numeric_limits<double>::infinity();
  const Program linearisation = trace(scene, Purpose::linearisation).program;
  if (linearisation.outputs.empty()) return std::numeric_limits<double>::infinity();
  return estimated_time(linearisation.run_operations()) / estimated_time(dynamics.run_operations());
}

std::string reason(const IntegratorChoice& choice, double price, std::size_t poses) {
  return fmt::format(
      "{}, {} step{} a tick: the cheapest ({:.3g} evaluations a tick) that keeps {:.1g} a tick; adds "
      "{:.1e} at most "
      "at {} ticks along the path",
      facts(choice.method).name, choice.substeps, choice.substeps == 1 ? "" : "s", price, choice.asked,
      choice.estimate, poses);
}

}  // namespace

std::vector<std::int64_t> ticks_to_look_at(std::int64_t ticks) {
  const std::int64_t count = std::min(ticks, kMostPoses);
  std::vector<std::int64_t> chosen;
  for (std::int64_t i = 0; i < count; ++i) chosen.push_back(i * ticks / count);
  return chosen;
}

std::vector<PlantPose> poses_on_plan(PlantProbe& probe, const Plan& plan, double rate_hz) {
  std::vector<PlantPose> poses;
  for (const std::int64_t k : ticks_to_look_at(plan.ticks()))
    poses.push_back(probe.on_plan(plan, k, rate_hz));
  return poses;
}

LocalError largest_local_error(PlantProbe& probe, const std::vector<PlantPose>& poses,
                               const IntegratorSettings& steps, const ChoiceTask& task) {
  return LocalErrors(probe, poses, task).largest(steps);
}

IntegratorChoice choose_integrator(PlantProbe& probe, const Plan& plan, const ChoiceTask& task) {
  const double of_jacobian = jacobian_cost(probe.shared_scene());
  const std::vector<PlantPose> poses = poses_on_plan(probe, plan, task.rate_hz);
  const std::vector<LinearPlant> plants = linearised(probe, poses);
  const StepTask steps_task{1 / task.rate_hz, plan.ticks(), task.ideal_drives};
  const MotionTolerance own_motion{.run = kOwnMotion, .tick = task.local_error / 2};
  LocalErrors errors(probe, poses, task);
  std::optional<IntegratorChoice> best;
  double least = 0;
  for (const MethodFacts& method : all_methods()) {
    if (method.method == Method::gauss8) continue;  // iterates: no fixed cost
    if (method.jacobian && !task.ideal_drives) continue;
    for (int substeps = 1; substeps <= kMostSubsteps; substeps *= 2) {
      const IntegratorSettings steps{method.method, substeps, 0};
      const double price = cost_of(steps, of_jacobian);
      if (best && price > least) break;
      const double error = errors.largest(steps).error;
      if (!(error <= task.local_error / 2) || misfit(steps, steps_task, plants, own_motion)) continue;
      best = IntegratorChoice{method.method, substeps, task.local_error, error, {}};
      least = price;
      break;
    }
  }
  if (!best)
    throw InputError(
        "out_of_reach", {},
        fmt::format("no integrator keeps a local error of {:g} with up to {} steps a tick; expected a larger "
                    "plant.local_error or rate",
                    task.local_error, kMostSubsteps));
  best->why = reason(*best, least, poses.size());
  return *best;
}

}  // namespace mixloop
