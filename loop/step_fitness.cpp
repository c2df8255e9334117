// SPDX-License-Identifier: MIT
#include "loop/step_fitness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/decompositions.hpp"
#include "notation/long_work.hpp"

namespace mixloop {
namespace {

using Complex = std::complex<double>;

constexpr double kGrowth = 1e-4;          // a tick: less is a matter of accuracy
constexpr double kLeft = 1e6;             // a motion that has grown so much is no more about that state
constexpr int kOrderEnough = 4;           // of a remedy, where the method in hand has as much
constexpr double kLinearisationCost = 3;  // of a Jacobian, in evaluations: what a remedy is picked by

/// The method's map of a tick on x' = A x.
Matrix map_of_tick(const IntegratorSettings& steps, const Matrix& A, double tick) {
  const Eigen::Index n = A.rows() / 2;
  Integrator integrator({steps.method, steps.substeps, 0}, n, 2 * n);
  Matrix map = Matrix::Identity(2 * n, 2 * n);
  for (Eigen::Index column = 0; column < 2 * n; ++column) {
    work_goes_on();
    Vector x = map.col(column);
    integrator.advance(
        x, tick, [&](int, int, double, const Vector& at, Vector& dx) { dx = A * at; },
        [&](double, const Vector&, auto& jacobian) {
          jacobian = {A.bottomLeftCorner(n, n), A.bottomRightCorner(n, n), Vector::Zero(n)};
        });
    map.col(column) = x;
  }
  return map;
}

/// How far a motion that is multiplied by `step` a tick falls from one that is by `truth`, within so many
/// ticks: in amplitudes that it starts with, of one that grows in those that it has. Of one that decays by
/// the steps too, it counts as much as a tick leaves of it. One that grows in truth soon leaves the state
/// that it was looked at about: then nothing more is said of it.
double largest_error(const Complex& step, const Complex& truth, std::int64_t ticks) {
  const double weight = std::abs(step) <= 1 ? std::min(1.0, std::abs(truth)) : 1;
  double largest = 0;
  Complex by_steps = step, in_truth = truth;
  for (std::int64_t k = 1; k <= ticks; k *= 2) {  // powers by squaring
    const double error = weight * std::abs(by_steps - in_truth) / std::max(1.0, std::abs(in_truth));
    if (!(error <= largest)) largest = error;
    if (!std::isfinite(error)) return HUGE_VAL;
    if (std::abs(in_truth) > kLeft) break;
    by_steps *= by_steps;
    in_truth *= in_truth;
  }
  return largest;
}

/// The eigenvalue of the method's map that stands for a motion of the plant's own: of a Runge-Kutta method
/// the one of the same eigenvector, of the others the nearest to what the map makes of that.
Complex take_value(std::vector<Complex>& among, const Matrix& map, const Vec<Complex>& motion) {
  const Complex made = motion.dot(map * motion);
  const auto nearest = std::min_element(among.begin(), among.end(), [&](const Complex& a, const Complex& b) {
    return std::abs(a - made) < std::abs(b - made);
  });
  const Complex value = *nearest;
  among.erase(nearest);
  return value;
}

/// What a tick adds to a motion whose largest coordinate is 1 rad or m, as error_size measures it.
double tick_error(const Matrix& difference, const Vec<Complex>& motion) {
  const Eigen::Index n = motion.size() / 2;
  const Vec<Complex> unit = motion / motion.head(n).cwiseAbs().maxCoeff();
  const Vector error = (difference * unit).cwiseAbs(), size = unit.cwiseAbs();
  double largest = 0;
  for (Eigen::Index i = 0; i < error.size(); ++i)
    if (const double here = error[i] / (1 + size[i]); !(here <= largest)) largest = here;
  return largest;
}

Misfit worst_motion(const IntegratorSettings& steps, const StepTask& task, const LinearPlant& plant) {
  Misfit worst{.t = plant.t};
  if (!plant.A.allFinite()) return worst;
  const Modes own = modes(plant.A);
  const Matrix map = map_of_tick(steps, plant.A, task.tick);
  const Matrix in_truth = exponential(plant.A * task.tick);
  const bool finite = map.allFinite();
  std::vector<Complex> by_steps;
  if (finite) {
    const auto values = eigenvalues(map);
    by_steps.assign(values.begin(), values.end());
  }
  for (Eigen::Index i = 0; i < own.values.size(); ++i) {
    const Complex pole = own.values[i], truth = std::exp(pole * task.tick),
                  step = finite ? take_value(by_steps, map, own.vectors.col(i)) : Complex(HUGE_VAL);
    const double error = largest_error(step, truth, task.ticks);
    if (const double here = tick_error(map - in_truth, own.vectors.col(i)); !(here <= worst.tick_error))
      worst.tick_error = here;
    // Of what is lost as a whole, the fastest motion is what it is lost by.
    if (error > worst.error || (!finite && std::abs(pole) > std::abs(worst.pole)))
      worst = {plant.t, pole, step, truth, error, worst.tick_error};
  }
  return worst;
}

/// The fewest steps a tick by which the method follows the plants; none up to kMostSubsteps.
std::optional<IntegratorSettings> enough_steps(Method method, int first, const StepTask& task,
                                               const std::vector<LinearPlant>& plants) {
  for (int substeps = first; substeps <= kMostSubsteps; substeps *= 2)
    if (const IntegratorSettings steps{method, substeps, 0}; !misfit(steps, task, plants)) return steps;
  return std::nullopt;
}

std::string pole_text(const Complex& pole) {
  return pole.imag() == 0 ? fmt::format("its pole at {:.6g} 1/s", pole.real())
         : std::abs(pole.real()) < 1e-9 * std::abs(pole)
             ? fmt::format("its oscillation of {:.6g} rad/s", std::abs(pole.imag()))
             : fmt::format("its oscillation of {:.6g} rad/s, pole at {:.4g} 1/s,", std::abs(pole.imag()),
                           pole.real());
}

std::string fate_text(const Misfit& misfit) {
  const double step = std::abs(misfit.step), truth = std::abs(misfit.truth);
  if (!std::isfinite(step)) return "is lost: the method's equations have no solution by iteration";
  if (misfit.grows())
    return fmt::format("grows {:.4g}-fold a tick; in truth it {}", step,
                       truth > 1          ? fmt::format("grows {:.4g}-fold", truth)
                       : truth > 1 - 1e-9 ? "stays"
                                          : fmt::format("shrinks to {:.3g}", truth));
  return fmt::format("is off by {:.3g} % of its amplitude within the run",
                     std::min(100 * misfit.error, 200.0));
}

std::string setting_text(const IntegratorSettings& steps) {
  return fmt::format("plant.integrator: {}{}", facts(steps.method).name,
                     steps.substeps > 1 ? fmt::format(" with plant.substeps: {}", steps.substeps) : "");
}

}  // namespace

bool Misfit::grows() const { return !(std::abs(step) <= std::max(1.0, std::abs(truth)) * (1 + kGrowth)); }

std::vector<LinearPlant> linearised(PlantProbe& probe, const std::vector<PlantPose>& poses) {
  std::vector<LinearPlant> plants;
  for (const PlantPose& pose : poses) plants.push_back({pose.t, probe.state_matrix(pose)});
  return plants;
}

double cost_of(const IntegratorSettings& steps, double jacobian_cost) {
  const MethodFacts& method = facts(steps.method);
  return steps.substeps * (method.evaluations + (method.jacobian ? jacobian_cost : 0)) +
         (steps.method == Method::leapfrog ? 1 : 0);
}

std::optional<Misfit> misfit(const IntegratorSettings& steps, const StepTask& task,
                             const std::vector<LinearPlant>& plants, const MotionTolerance& tolerance) {
  if (steps.local_error > 0 && facts(steps.method).error_control) return std::nullopt;
  std::optional<Misfit> worst;
  for (const LinearPlant& plant : plants)
    if (const Misfit here = worst_motion(steps, task, plant);
        (here.error > tolerance.run || here.tick_error > tolerance.tick) &&
        !(worst && here.error <= worst->error))
      worst = here;
  return worst;
}

std::string describe(const Misfit& misfit, const IntegratorSettings& steps, const StepTask& task,
                     const std::vector<LinearPlant>& plants) {
  std::optional<IntegratorSettings> other;
  const int order = std::min(facts(steps.method).order, kOrderEnough);
  for (const MethodFacts& method : all_methods()) {
    if (method.method == steps.method || method.method == Method::gauss8) continue;  // which iterates
    if (method.order < order) continue;
    if (method.jacobian && !task.ideal_drives) continue;
    const auto enough = enough_steps(method.method, 1, task, plants);
    if (enough && !(other && cost_of(*other, kLinearisationCost) <= cost_of(*enough, kLinearisationCost)))
      other = enough;
  }
  std::string remedy;
  if (const auto same = enough_steps(steps.method, 2 * steps.substeps, task, plants))
    remedy = fmt::format("plant.substeps: {}", same->substeps);
  if (other) remedy += (remedy.empty() ? "" : ", or ") + setting_text(*other);
  if (remedy.empty()) remedy = "a higher rate, or a plant that is less stiff";
  return fmt::format(
      "{} with {} step{} a tick of {:.4g} ms is too coarse for the plant itself: at {:.4g} s {} {}; "
      "expected {}",
      facts(steps.method).name, steps.substeps, steps.substeps == 1 ? "" : "s", 1e3 * task.tick, misfit.t,
      pole_text(misfit.pole), fate_text(misfit), remedy);
}

}  // namespace mixloop
