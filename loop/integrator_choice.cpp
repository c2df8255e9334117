// SPDX-License-Identifier: MIT
#include "loop/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "dynamics/equations.hpp"
#include "dynamics/procedure/decompositions.hpp"
#include "dynamics/program/trace.hpp"
#include "integrators/integrator.hpp"
#include "notation/errors.hpp"

namespace mixloop {
namespace {

constexpr std::int64_t kMostSamples = 48;
constexpr int kMostSubsteps = 256;

/// A tick of the path: where it starts, what is held over it, and where it ends.
struct Sample {
  double t = 0;
  Vector start, tau, end;
  AccelerationJacobian<double> jacobian;
};

class Chooser {
 public:
  Chooser(const std::shared_ptr<const Scene>& scene, const std::vector<double>& parameters, double rate_hz,
          double local_error)
      : dynamics_(
            equations_of(scene, Evaluation::machine_code,
                         {Purpose::forward_dynamics, Purpose::inverse_dynamics, Purpose::linearisation}),
            parameters),
        n_(scene->n()),
        tick_(1 / rate_hz),
        local_error_(local_error),
        jacobian_cost_(cost_of(scene, Purpose::linearisation) / cost_of(scene, Purpose::forward_dynamics)) {}

  void look(const Plan& plan) {
    const std::int64_t count = std::min(plan.ticks(), kMostSamples);
    const double finest = std::max(1e-15, local_error_ * 1e-3);
    Integrator reference({Method::dop853, 1, finest}, n_, 2 * n_);
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t k = i * plan.ticks() / count;
      const Reference at = plan.at(k);
      Sample sample{static_cast<double>(k) * tick_, Vector(2 * n_), Vector(n_), {}, {}};
      sample.start << at.psi, at.psid;
      dynamics_.evaluate(Purpose::inverse_dynamics,
                         {span_of(at.psi), span_of(at.psid), span_of(at.psidd), sample.t},
                         span_of(sample.tau));
      sample.jacobian = {Matrix(n_, n_), Matrix(n_, n_), Vector::Zero(n_)};
      linearise(sample, sample.t, sample.start, sample.jacobian);
      sample.end = advanced(reference, sample);
      samples_.push_back(std::move(sample));
    }
  }

  std::optional<IntegratorChoice> cheapest(bool jacobian) {
    std::optional<IntegratorChoice> best;
    double least = 0;
    for (const MethodFacts& method : all_methods()) {
      if (method.method == Method::gauss8) continue;  // iterates: no fixed cost
      if (method.jacobian && !jacobian) continue;
      for (int substeps = 1; substeps <= kMostSubsteps; substeps *= 2) {
        const double price = cost(method, substeps);
        if (best && price > least) break;
        const double error = largest_error(method.method, substeps);
        if (!(error <= local_error_ / 2) || !stable(method.method, substeps)) continue;
        best = IntegratorChoice{method.method, substeps, local_error_, error, {}};
        least = price;
        break;
      }
    }
    if (best) best->why = reason(*best, least);
    return best;
  }

 private:
  static double cost_of(const std::shared_ptr<const Scene>& scene, Purpose purpose) {
    return estimated_time(trace(scene, purpose).program.run_operations());
  }

  /// In evaluations of the forward dynamics a tick.
  double cost(const MethodFacts& method, int substeps) const {
    return substeps * (method.evaluations + (method.jacobian ? jacobian_cost_ : 0)) +
           (method.method == Method::leapfrog ? 1 : 0);
  }

  void linearise(const Sample& sample, double t, const Vector& x, AccelerationJacobian<double>& jacobian) {
    Vector out(3 * n_ * n_);
    dynamics_.evaluate(Purpose::linearisation, {psi(x), psid(x), span_of(sample.tau), t}, span_of(out));
    jacobian.by_q = Eigen::Map<const Matrix>(out.data(), n_, n_);
    jacobian.by_v = Eigen::Map<const Matrix>(out.data() + n_ * n_, n_, n_);
  }

  Vector advanced(Integrator<>& integrator, const Sample& sample) {
    Vector x = sample.start;
    integrator.advance(
        x, tick_,
        [&](int, int, double after, const Vector& at, Vector& dx) {
          dx.head(n_) = at.tail(n_);
          dynamics_.evaluate(Purpose::forward_dynamics,
                             {psi(at), psid(at), span_of(sample.tau), sample.t + after},
                             {dx.data() + n_, static_cast<std::size_t>(n_)});
        },
        [&](double after, const Vector& at, auto& jacobian) {
          linearise(sample, sample.t + after, at, jacobian);
        });
    return x;
  }

  double largest_error(Method method, int substeps) {
    Integrator integrator({method, substeps, 0}, n_, 2 * n_);
    double largest = 0;
    for (const Sample& sample : samples_) {
      const double error = error_size<double>(advanced(integrator, sample) - sample.end, sample.start, n_);
      if (!(error <= largest)) largest = error;
      if (!(largest <= local_error_)) break;
    }
    return largest;
  }

  /// Whether the method's map of a tick, on the linearised plant, grows no faster than the plant itself.
  bool stable(Method method, int substeps) {
    for (const Sample& sample : samples_) {
      Matrix J = Matrix::Zero(2 * n_, 2 * n_);
      J.topRightCorner(n_, n_).setIdentity();
      J.bottomLeftCorner(n_, n_) = sample.jacobian.by_q;
      J.bottomRightCorner(n_, n_) = sample.jacobian.by_v;
      const double growth = std::exp(std::max(0.0, eigenvalues(J).real().maxCoeff()) * tick_);
      if (!(eigenvalues(map_of_tick(method, substeps, J, sample)).cwiseAbs().maxCoeff() <=
            growth * (1 + 1e-4)))
        return false;
    }
    return true;
  }

  Matrix map_of_tick(Method method, int substeps, const Matrix& J, const Sample& sample) const {
    Integrator integrator({method, substeps, 0}, n_, 2 * n_);
    Matrix map = Matrix::Identity(2 * n_, 2 * n_);
    for (int column = 0; column < 2 * n_; ++column) {
      Vector x = map.col(column);
      integrator.advance(
          x, tick_, [&](int, int, double, const Vector& at, Vector& dx) { dx = J * at; },
          [&](double, const Vector&, auto& jacobian) { jacobian = sample.jacobian; });
      map.col(column) = x;
    }
    return map;
  }

  std::string reason(const IntegratorChoice& choice, double price) const {
    return fmt::format(
        "{}, {} step{} a tick: the cheapest ({:.3g} evaluations a tick) that keeps {:.1g} a tick; adds "
        "{:.1e} at most "
        "at {} ticks along the path",
        facts(choice.method).name, choice.substeps, choice.substeps == 1 ? "" : "s", price, choice.asked,
        choice.estimate, samples_.size());
  }

  std::span<const double> psi(const Vector& x) const { return {x.data(), static_cast<std::size_t>(n_)}; }
  std::span<const double> psid(const Vector& x) const {
    return {x.data() + n_, static_cast<std::size_t>(n_)};
  }

  Equations::Workspace dynamics_;
  int n_;
  double tick_, local_error_, jacobian_cost_;
  std::vector<Sample> samples_;
};

}  // namespace

IntegratorChoice choose_integrator(const std::shared_ptr<const Scene>& scene,
                                   const std::vector<double>& parameters, const Plan& plan, double rate_hz,
                                   double local_error, bool jacobian) {
  Chooser chooser(scene, parameters, rate_hz, local_error);
  chooser.look(plan);
  if (const auto choice = chooser.cheapest(jacobian)) return *choice;
  throw InputError(
      "out_of_reach", {},
      fmt::format("no integrator keeps a local error of {:g} with up to {} steps a tick; expected a larger "
                  "plant.local_error or rate",
                  local_error, kMostSubsteps));
}

}  // namespace mixloop
