// SPDX-License-Identifier: MIT
#include "plant/plant.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/scene/time_dependence.hpp"
#include "plant/hardware.hpp"

namespace mixloop {

std::shared_ptr<const Equations> plant_equations(std::shared_ptr<const Scene> scene, Evaluation how,
                                                 const PlantSettings& settings) {
  const Equations::Options options{.friction_factor = settings.faults.change_friction()};
  if (!facts(settings.integrator).jacobian)
    return equations_of(std::move(scene), how, {Purpose::forward_dynamics}, options);
  return equations_of(std::move(scene), how, {Purpose::forward_dynamics, Purpose::linearisation}, options);
}

Plant::Plant(Equations::Workspace dynamics, PlantSettings settings, double rate_hz,
             std::span<const double> psi0)
    : dynamics_(std::move(dynamics)),
      settings_(std::move(settings)),
      rate_hz_(rate_hz),
      n_(psi0.size()),
      x_(Vector::Zero(static_cast<Eigen::Index>(2 * n_ + 1))),
      applied_(Vector::Zero(static_cast<Eigen::Index>(n_))),
      before_(applied_),
      scratch_(applied_),
      integrator_({settings_.integrator, settings_.substeps, settings_.local_error}, applied_.size(),
                  x_.size()),
      rows_(stage_rows(settings_.integrator)),
      linearisation_(Vector::Zero(3 * applied_.size() * applied_.size())),
      timed_(constraints_depend_on_time(dynamics_.scene()) || loads_depend_on_time(dynamics_.scene())) {
  std::copy(psi0.begin(), psi0.end(), x_.data());
  // A delay within a billionth of whole ticks is whole.
  const double ticks = settings_.command_delay * rate_hz_;
  delay_ticks_ = static_cast<std::size_t>(std::floor(ticks + 1e-9));
  const double rest = ticks - static_cast<double>(delay_ticks_);
  delay_rest_ = rest > 1e-9 ? rest / rate_hz_ : 0;
  commands_.assign(delay_ticks_ + 2, applied_);
  if (!Hardware::needed(settings_)) return;
  hardware_ = std::make_unique<Hardware>(settings_, dynamics_.scene(), rate_hz_);
  begin_hardware_tick();
}

void Plant::begin_tick() {
  ++tick_;
  if (hardware_) begin_hardware_tick();
}

void Plant::command(std::span<const double> tau) {
  const auto slot = static_cast<std::size_t>(tick_) % commands_.size();
  commands_[slot] = map_of(tau);
  // The robot starts held: COMMAND(0) also acts before it is due.
  if (tick_ == 0) std::fill(commands_.begin(), commands_.end(), commands_[slot]);
  const std::size_t age = delay_ticks_ + (delay_rest_ > 0 ? 1 : 0);
  saturate(span_of(std::as_const(commands_[(slot + commands_.size() - age) % commands_.size()])));
}

void Plant::advance() {
  const std::size_t slot =
      (static_cast<std::size_t>(tick_) + commands_.size() - delay_ticks_) % commands_.size();
  const double tick_length = 1.0 / rate_hz_;
  if (delay_rest_ > 0) integrate_held(time(), delay_rest_);
  saturate(span_of(std::as_const(commands_[slot])));
  integrate_held(time() + delay_rest_, tick_length - delay_rest_);
  begin_tick();
}

void Plant::take_effect(double offset, std::span<const double> tau) {
  const double to = std::clamp(offset, within_, 1.0 / rate_hz_);
  if (to > within_) integrate_held(time() + within_, to - within_);
  within_ = to;
  saturate(tau);
}

void Plant::finish_tick() {
  const double rest = 1.0 / rate_hz_ - within_;
  if (rest > 0) integrate_held(time() + within_, rest);
  within_ = 0;
  begin_tick();
}

void Plant::lock() {
  const auto n = static_cast<Eigen::Index>(n_);
  x_.segment(n, n).setZero();
  applied_.setZero();
  locked_ = true;
}

void Plant::acceleration(std::span<double> psidd) {
  dynamics_.evaluate(Purpose::forward_dynamics, {psi(), psid(), applied(), time()}, psidd);
}

void Plant::saturate(std::span<const double> tau) { hardware_ ? saturate_by_hardware(tau) : limit(tau); }

void Plant::limit(std::span<const double> tau) {
  for (std::size_t i = 0; i < n_; ++i) {
    const double limit = settings_.torque_limit.empty() ? HUGE_VAL : settings_.torque_limit[i];
    applied_[static_cast<Eigen::Index>(i)] = std::clamp(tau[i], -limit, limit);
  }
}

void Plant::integrate_held(double t, double length) {
  if (locked_) return;
  if (hardware_) return integrate_driven(t, length);
  const auto rate = [&](int, int, double after, const Vector& x, Vector& dx) { rate_of(t + after, x, dx); };
  const auto linear = [&](double after, const Vector& x, auto& jacobian) {
    linearise(t + after, x, jacobian);
  };
  if (!facts(settings_.integrator).jacobian) return integrator_.advance(x_, length, rate, linear);
  before_ = x_.head(static_cast<Eigen::Index>(n_));
  integrator_.advance(x_, length, rate, linear);
  add_work_since_before();
}

/// The work of the torque held since psi was before_, which methods with a Jacobian leave alone: tau . (psi+
/// - psi).
void Plant::add_work_since_before() {
  const auto n = static_cast<Eigen::Index>(n_);
  before_ = x_.head(n) - before_;
  x_[2 * n] += applied_.dot(before_);
}

/// psi' = psi', psi'' by forward dynamics, work' = tau . psi'.
void Plant::rate_of(double t, const Vector& x, Vector& dx) {
  const std::span<const double> psi(x.data(), n_), psid(x.data() + n_, n_);
  std::copy(psid.begin(), psid.end(), dx.data());
  dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, applied(), t}, {dx.data() + n_, n_});
  const auto n = static_cast<Eigen::Index>(n_);
  dx[2 * n] = applied_.dot(x.segment(n, n));
}

void Plant::linearise(double t, const Vector& x, AccelerationJacobian<double>& jacobian) {
  const auto n = static_cast<Eigen::Index>(n_);
  dynamics_.evaluate(Purpose::linearisation, {{x.data(), n_}, {x.data() + n_, n_}, applied(), t},
                     span_of(linearisation_));
  jacobian.by_q = Eigen::Map<const Matrix>(linearisation_.data(), n, n);
  jacobian.by_v = Eigen::Map<const Matrix>(linearisation_.data() + n * n, n, n);
  if (timed_) time_derivative(t, x, jacobian.by_t);
}

/// By a central difference over a cube root of round-off: to 1e-10 of the acceleration.
void Plant::time_derivative(double t, const Vector& x, Vector& by_t) {
  const double d = 6e-6 * std::max(1.0, std::abs(t));
  const std::span<const double> psi(x.data(), n_), psid(x.data() + n_, n_);
  dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, applied(), t + d}, span_of(by_t));
  dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, applied(), t - d}, span_of(scratch_));
  by_t = (by_t - scratch_) / (2 * d);
}

}  // namespace mixloop
