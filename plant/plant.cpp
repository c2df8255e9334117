// SPDX-License-Identifier: MIT
#include "plant/plant.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {

Plant::Plant(Dynamics dynamics, PlantSettings settings, double rate_hz, std::span<const double> psi0)
    : dynamics_(std::move(dynamics)),
      settings_(std::move(settings)),
      rate_hz_(rate_hz),
      n_(psi0.size()),
      x_(Vector::Zero(static_cast<Eigen::Index>(2 * n_ + 1))),
      applied_(Vector::Zero(static_cast<Eigen::Index>(n_))),
      rk4_(x_.size()) {
  std::copy(psi0.begin(), psi0.end(), x_.data());
  // A delay within a billionth of whole ticks is whole.
  const double ticks = settings_.command_delay * rate_hz_;
  delay_ticks_ = static_cast<std::size_t>(std::floor(ticks + 1e-9));
  const double rest = ticks - static_cast<double>(delay_ticks_);
  delay_rest_ = rest > 1e-9 ? rest / rate_hz_ : 0;
  commands_.assign(delay_ticks_ + 2, applied_);
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
  ++tick_;
}

void Plant::acceleration(std::span<double> psidd) {
  dynamics_.forward_dynamics(psi(), psid(), applied(), time(), psidd);
}

void Plant::saturate(std::span<const double> tau) {
  for (std::size_t i = 0; i < n_; ++i) {
    const double limit = settings_.torque_limit.empty() ? HUGE_VAL : settings_.torque_limit[i];
    applied_[static_cast<Eigen::Index>(i)] = std::clamp(tau[i], -limit, limit);
  }
}

void Plant::integrate_held(double t, double length) {
  const double h = length / settings_.substeps;
  for (int step = 0; step < settings_.substeps; ++step)
    rk4_step(
        x_, h, [&](int, double c, const Vector& x, Vector& dx) { rate_of(t + (step + c) * h, x, dx); }, rk4_);
}

/// psi' = psi', psi'' by forward dynamics, work' = tau . psi'.
void Plant::rate_of(double t, const Vector& x, Vector& dx) {
  const std::span<const double> psi(x.data(), n_), psid(x.data() + n_, n_);
  std::copy(psid.begin(), psid.end(), dx.data());
  dynamics_.forward_dynamics(psi, psid, applied(), t, {dx.data() + n_, n_});
  const auto n = static_cast<Eigen::Index>(n_);
  dx[2 * n] = applied_.dot(x.segment(n, n));
}

}  // namespace mixloop
