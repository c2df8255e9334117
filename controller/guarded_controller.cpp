// SPDX-License-Identifier: MIT
#include "controller/guarded_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/scene/coordinate_values.hpp"
#include "notation/number_text.hpp"

namespace mixloop {
namespace {

constexpr double kStartTolerance = 0.02;  // rad or m: far above what a sensor errs, far below what throws

}  // namespace

GuardedController::GuardedController(Controller controller, SafetySettings settings, Vector damping)
    : controller_(std::move(controller)),
      settings_(std::move(settings)),
      damping_(std::move(damping)),
      trusted_psid_(Vector::Zero(damping_.size())),
      before_(trusted_psid_) {}

void GuardedController::begin() {
  trusted_psid_.setZero();
  when_.reset();
  out_of_range_.reset();
  stale_ = 0;
}

std::string GuardedController::start_refusal(std::span<const double> psi, const Reference& start) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(start.psi.size()); ++i) {
    const double tolerance =
        settings_.start_tolerance.empty() ? kStartTolerance : settings_.start_tolerance[i];
    const double should = start.psi[static_cast<Eigen::Index>(i)];
    if (std::abs(psi[i] - should) <= tolerance) continue;
    return fmt::format(
        "motor {0} stands at {1} {4}, the path starts at {2} {4}, farther than "
        "controller.safety.start_tolerance ({3} {4}): say where it stands by plant.initial, and "
        "path.approach to move "
        "there",
        i + 1, fixed(psi[i], 6), fixed(should, 6), fixed(tolerance, 6),
        position_unit(controller_.scene().motors()[i].linear));
  }
  return "";
}

CommandMarks GuardedController::torque(const Measurement& now, const Reference& desired,
                                       std::span<double> tau) {
  stale_ = now.stale ? stale_ + 1 : 0;
  if (out_of_range_ || !in_range(now)) return safe(tau);
  if (stale_ > settings_.max_stale) return safe(tau);
  if (!now.stale) trusted_psid_ = map_of(now.psid.first(tau.size()));
  controller_.torque(now, desired, tau);
  return {.limited = limit(now.t, tau)};
}

void GuardedController::safe_torque(std::span<double> tau) const {
  Eigen::Map<Vector> out(tau.data(), static_cast<Eigen::Index>(tau.size()));
  if (settings_.safe_command == SafeCommand::damp)
    out = -damping_.cwiseProduct(trusted_psid_);
  else
    out.setZero();
}

bool GuardedController::in_range(const Measurement& now) {
  const auto fast = [&](std::size_t i) { return std::abs(now.psid[i]) > settings_.velocity_limit[i]; };
  const auto out = [&](std::size_t i) {
    return now.psi[i] < settings_.position_range[i][0] || now.psi[i] > settings_.position_range[i][1];
  };
  const auto n_u = static_cast<std::size_t>(damping_.size());
  for (std::size_t i = 0; i < n_u && !out_of_range_; ++i)
    if ((!settings_.velocity_limit.empty() && fast(i)) || (!settings_.position_range.empty() && out(i)))
      out_of_range_ = static_cast<int>(i) + 1;
  return !out_of_range_;
}

/// Torque after rate: the torque limit holds whatever came before.
bool GuardedController::limit(double t, std::span<double> tau) {
  bool limited = false;
  const auto clamp = [&limited](double& value, double least, double most) {
    const double within = std::clamp(value, least, most);
    limited = limited || within != value;
    value = within;
  };
  for (std::size_t i = 0; i < tau.size(); ++i) {
    double& before = before_[static_cast<Eigen::Index>(i)];
    if (!settings_.torque_rate_limit.empty() && when_) {
      const double step = settings_.torque_rate_limit[i] * (t - *when_);
      clamp(tau[i], before - step, before + step);
    }
    if (!settings_.torque_limit.empty()) clamp(tau[i], -settings_.torque_limit[i], settings_.torque_limit[i]);
    before = tau[i];
  }
  when_ = t;
  return limited;
}

}  // namespace mixloop
