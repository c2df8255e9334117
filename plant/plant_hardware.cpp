// SPDX-License-Identifier: MIT
// What a plant does that isn't ideal.
#include <algorithm>

#include "plant/hardware.hpp"
#include "plant/plant.hpp"

namespace mixloop {

bool Plant::measure(std::span<double> psi_out, std::span<double> psid_out) {
  if (hardware_ && hardware_->sensors)
    return hardware_->sensors->measure(tick_, psi(), psid(), hardware_->faults ? &*hardware_->faults : nullptr, psi_out,
                                       psid_out);
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
  if (hardware.faults && hardware.faults->changed_at() == tick_) {
    dynamics_.set_parameters(hardware.faults->parameters());
    if (hardware.scene_friction) hardware.scene_friction->set_parameters(hardware.faults->parameters());
  }
  if (hardware.was_asked()) saturate(hardware.asked());
}

void Plant::drive(double s, std::span<const double> psi, std::span<const double> psid) {
  if (hardware_->actuators) hardware_->actuators->torque(s, psi, psid, hardware_->friction(), span_of(applied_));
}

void Plant::driven_rate_of(double s, double t, const Vector& x, Vector& dx) {
  const std::span<const double> psi(x.data(), n_), psid(x.data() + n_, n_);
  drive(s, psi, psid);
  rate_of(t, x, dx);
  scale_friction(psi, psid, t, {dx.data() + n_, n_});
}

void Plant::scale_friction(std::span<const double> psi, std::span<const double> psid, double t,
                           std::span<double> psidd) {
  if (hardware_->friction_scaled())
    hardware_->scene_friction->scale(psi, psid, applied(), t, hardware_->friction(), psidd);
}

}  // namespace mixloop
