// SPDX-License-Identifier: MIT
// What a plant does that isn't ideal.
#include <algorithm>

#include "plant/hardware.hpp"
#include "plant/plant.hpp"

namespace mixloop {

Plant::~Plant() = default;
Plant::Plant(Plant&&) noexcept = default;

bool Plant::measure(std::span<double> psi_out, std::span<double> psid_out) {
  if (hardware_ && hardware_->sensors)
    return hardware_->sensors->measure(tick_, psi(), psid(),
                                       hardware_->faults ? &*hardware_->faults : nullptr, psi_out, psid_out);
  std::copy(psi().begin(), psi().end(), psi_out.begin());
  std::copy(psid().begin(), psid().end(), psid_out.begin());
  return false;
}

bool Plant::measures_exactly() const { return !hardware_ || !hardware_->sensors; }

const Faults* Plant::faults() const { return hardware_ && hardware_->faults ? &*hardware_->faults : nullptr; }

bool Plant::inject(const Fault& fault) {
  if (!settings_.faults.injected || !hardware_->faults->inject(fault, dynamics_.scene(), tick_)) return false;
  take_changes();
  return true;
}

void Plant::begin_hardware_tick() {
  if (hardware_->faults) hardware_->faults->begin(tick_);
  take_changes();
}

/// What changed with the tick in hand comes into force.
void Plant::take_changes() {
  Hardware& hardware = *hardware_;
  if (hardware.faults && hardware.faults->changed_at() == tick_)
    dynamics_.set_parameters(hardware.faults->parameters(), hardware.faults->friction());
  if (hardware.was_asked() && !locked_) saturate(hardware.asked());
}

void Plant::saturate_by_hardware(std::span<const double> tau) {
  limit(hardware_->through_faults(tick_, tau));
  if (!hardware_->actuators) return;
  hardware_->actuators->take(applied());
  drive(0, psi(), psid());
}

/// As integrate_held; pieces end where a torque has a kink.
void Plant::integrate_driven(double t, double length) {
  auto& actuators = hardware_->actuators;
  double done = 0;
  const auto rate = [&](int, int, double after, const Vector& x, Vector& dx) {
    driven_rate_of(done + after, t + done + after, x, dx);
  };
  const auto linear = [&](double after, const Vector& x, auto& jacobian) {
    linearise(t + after, x, jacobian);
  };
  const bool jacobian = facts(settings_.integrator).jacobian;  // then there are no actuators
  if (jacobian) before_ = x_.head(static_cast<Eigen::Index>(n_));
  while (done < length) {
    double end = actuators ? actuators->next_kink(done) : length;
    if (!(end < length * (1 - 1e-9))) end = length;
    integrator_.advance(x_, end - done, rate, linear);
    done = end;
  }
  if (jacobian) add_work_since_before();
  if (actuators) actuators->pass(length);
}

void Plant::drive(double s, std::span<const double> psi, std::span<const double> psid) {
  if (hardware_->actuators)
    hardware_->actuators->torque(s, psi, psid, hardware_->friction(), span_of(applied_));
}

void Plant::driven_rate_of(double s, double t, const Vector& x, Vector& dx) {
  drive(s, {x.data(), n_}, {x.data() + n_, n_});
  rate_of(t, x, dx);
}

}  // namespace mixloop
