// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamics/procedure/purpose.hpp"
#include "dynamics/program/routine.hpp"
#include "integrators/integrator.hpp"
#include "plant/plant_model.hpp"
#include "plant/plant_state.hpp"

namespace mixloop {

/// A plant with ideal drives and sensors, on any scalar: its constant model and what an evaluation needs
/// beside it; states are the caller's. `Dynamics` (Equations::Workspace) has evaluate(purpose, {psi, psid,
/// tau, t}, out) for the forward dynamics and, for methods with a Jacobian, their linearisation. Nothing
/// allocates after construction.
template <class T, class Dynamics>
class IdealPlant {
 public:
  using State = IdealState<T>;

  IdealPlant(PlantModel model, Dynamics dynamics)
      : model_(std::move(model)),
        dynamics_(std::move(dynamics)),
        integrator_(model_.integrator, n(), 2 * n() + 1),
        before_(n_u()),
        slopes_(n() * (2 * n() + n_u())) {}

  const PlantModel& model() const { return model_; }
  Dynamics& dynamics() { return dynamics_; }
  const Dynamics& dynamics() const { return dynamics_; }
  Integrator<T>& integrator() { return integrator_; }

  /// `tau` acts from now on, as far as the motors can give it.
  void take(State& state, std::span<const T> tau) const {
    using std::clamp;
    for (std::size_t i = 0; i < model_.n_u; ++i) {
      const double limit = model_.torque_limit.empty() ? HUGE_VAL : model_.torque_limit[i];
      state.applied[static_cast<Eigen::Index>(i)] = clamp(tau[i], T(-limit), T(limit));
    }
  }

  /// Goes on from time `t` over `length` s, what is applied held.
  void integrate(State& state, double t, double length) {
    if constexpr (requires { dynamics_.has_steps(StepsBy::rk4); })
      if (const auto method = compiled_method(); method && dynamics_.has_steps(*method)) {
        const int steps = model_.integrator.substeps;
        return dynamics_.go_on(*method, span_of(state.x), span_of(state.applied), t, length / steps, steps);
      }
    integrate(state, t, length,
              [&](const T& after, const Vec<T>& x, Vec<T>& dx) { rate_of(state, t + after, x, dx); });
  }

  /// The same by `rate(after, x, dx)`, `after` s after t.
  template <class Rate>
  void integrate(State& state, double t, double length, const Rate& rate) {
    integrate_by(state, length, rate, [&](const T& after, const Vec<T>& x, auto& jacobian) {
      linearise(state, t + after, x, jacobian);
    });
  }
  /// And `linear(after, x, jacobian)`, of methods that take one.
  template <class Rate, class Linear>
  void integrate_by(State& state, double length, const Rate& rate, const Linear& linear) {
    const auto at = [&](int, int, const T& after, const Vec<T>& x, Vec<T>& dx) { rate(after, x, dx); };
    if (!model_.jacobian) return integrator_.advance(state.x, length, at, linear);
    // Methods with a Jacobian leave the work alone: tau . (psi+ - psi) of the motors, the torque held.
    before_ = state.x.head(n_u());
    integrator_.advance(state.x, length, at, linear);
    before_ = state.x.head(n_u()) - before_;
    state.x[2 * n()] += state.applied.dot(before_);
  }

  /// psi' = psi', psi'' by forward dynamics, work' = tau . psi'.
  void rate_of(const State& state, const T& t, const Vec<T>& x, Vec<T>& dx) {
    const std::span<const T> psi(x.data(), model_.n), psid(x.data() + n(), model_.n);
    std::copy(psid.begin(), psid.end(), dx.data());
    dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, span_of(state.applied), t},
                       {dx.data() + n(), model_.n});
    dx[2 * n()] = state.applied.dot(x.segment(n(), n_u()));
  }

  /// psi'' by psi, psi' and, where the dynamics depend on it, t, what is applied held.
  void linearise(const State& state, const T& t, const Vec<T>& x, AccelerationJacobian<T>& jacobian) {
    const std::span<const T> psi(x.data(), model_.n), psid(x.data() + n(), model_.n);
    dynamics_.evaluate(Purpose::linearisation, {psi, psid, span_of(state.applied), t}, span_of(slopes_));
    jacobian.by_q = Eigen::Map<const Mat<T>>(slopes_.data(), n(), n());
    jacobian.by_v = Eigen::Map<const Mat<T>>(slopes_.data() + n() * n(), n(), n());
    if (!model_.timed) return;
    // By a central difference over a cube root of round-off: to 1e-10 of the acceleration.
    using std::abs, std::max;
    const T d = 6e-6 * max(T(1), T(abs(t)));
    auto later = span_of(jacobian.by_t), earlier = span_of(slopes_).first(model_.n);
    dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, span_of(state.applied), t + d}, later);
    dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, span_of(state.applied), t - d}, earlier);
    jacobian.by_t = (jacobian.by_t - slopes_.head(n())) / (2 * d);
  }

 private:
  std::optional<StepsBy> compiled_method() const {
    const Method method = model_.integrator.method;
    if (method == Method::rk4) return StepsBy::rk4;
    if (method == Method::leapfrog) return StepsBy::leapfrog;
    return std::nullopt;
  }

  Eigen::Index n() const { return static_cast<Eigen::Index>(model_.n); }
  Eigen::Index n_u() const { return static_cast<Eigen::Index>(model_.n_u); }

  PlantModel model_;
  Dynamics dynamics_;
  Integrator<T> integrator_;
  Vec<T> before_, slopes_;  ///< n_u; n (2 n + n_u), of methods with a Jacobian
};

}  // namespace mixloop
