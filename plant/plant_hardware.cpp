// SPDX-License-Identifier: MIT
// What a plant does that isn't ideal.
#include "plant/plant.hpp"

namespace mixloop {

bool Plant::measure(std::span<double> psi_out, std::span<double> psid_out) {
  if (hardware_ && hardware_->sensors)
    return hardware_->sensors->measure(state_.hardware.sensors, tick(), psi(), psid(),
                                       hardware_->faults ? &state_.hardware.faults : nullptr, psi_out,
                                       psid_out);
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const auto of = static_cast<std::size_t>(measured_[i]);
    psi_out[i] = psi()[of];
    psid_out[i] = psid()[of];
  }
  return false;
}

bool Plant::inject(const Fault& fault) {
  if (!faults_may_come_ || !hardware_->faults->inject(state_.hardware.faults, fault, declared(), tick()))
    return false;
  take_changes();
  return true;
}

void Plant::begin_tick() {
  follow_closures();
  if (!hardware_) return;
  if (hardware_->faults) hardware_->faults->begin(state_.hardware.faults, tick());
  take_changes();
}

/// What changed with the tick in hand comes into force.
void Plant::take_changes() {
  const HardwareState& hardware = state_.hardware;
  if (const auto* faults = this->faults(); faults && faults->changed_at == tick()) set_parameters(*faults);
  if (hardware.was_asked && !state_.motion.locked) take(span_of(hardware.asked));
}

/// Through the motors' faults, saturation and the drives.
void Plant::take_by_hardware(std::span<const double> tau) {
  auto& motion = state_.motion;
  auto& hardware = state_.hardware;
  if (tau.data() != hardware.asked.data()) hardware.asked = map_of(tau);
  hardware.was_asked = true;
  for (std::size_t i = 0; i < tau.size(); ++i)
    motion.applied[static_cast<Eigen::Index>(i)] =
        hardware_->faults ? hardware.faults.motors[i].pass(tick(), tau[i]) : tau[i];
  ideal_.take(motion, applied());
  if (!hardware_->actuators) return;
  hardware_->actuators->take(hardware.actuators, applied());
  drive(0, psi(), psid());
}

/// Pieces end where a torque has a kink.
void Plant::integrate_driven(double t, double length) {
  const Actuators* actuators = hardware_ && hardware_->actuators ? &*hardware_->actuators : nullptr;
  auto& motion = state_.motion;
  auto& hardware = state_.hardware;
  double done = 0;
  while (done < length) {
    double end = actuators ? actuators->next_kink(hardware.actuators, done) : length;
    if (!(end < length * (1 - 1e-9))) end = length;
    ideal_.integrate(motion, t + done, end - done, [&](double after, const Vector& x, Vector& dx) {
      driven_rate_of(done + after, t + done + after, x, dx);
    });
    done = end;
  }
  if (actuators) actuators->pass(hardware.actuators, length);
}

/// What the drives make of the torque, `s` seconds after it was asked for.
void Plant::drive(double s, std::span<const double> psi, std::span<const double> psid) {
  if (!hardware_ || !hardware_->actuators) return;
  const double friction = hardware_->faults ? state_.hardware.faults.friction : 1;
  hardware_->actuators->torque(state_.hardware.actuators, s, psi, psid, friction,
                               span_of(state_.motion.applied));
}

void Plant::driven_rate_of(double s, double t, const Vector& x, Vector& dx) {
  auto& motion = state_.motion;
  const auto [psi, psid] = declared_at(t, x);
  drive(s, psi, psid);
  ideal_.rate_of(motion, t, x, dx);
  if (is_switched()) dx[dx.size() - 1] = motion.applied.dot(map_of(psid).head(motion.applied.size()));
}

}  // namespace mixloop
