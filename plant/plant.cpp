// SPDX-License-Identifier: MIT
#include "plant/plant.hpp"

#include "plant/tick.hpp"

namespace mixloop {

std::shared_ptr<const Equations> plant_equations(std::shared_ptr<const Scene> scene, Evaluation how,
                                                 const PlantSettings& settings) {
  const Equations::Options options{.friction_factor = settings.faults.change_friction()};
  if (!facts(settings.integrator).jacobian)
    return equations_of(std::move(scene), how, {Purpose::forward_dynamics}, options);
  return equations_of(std::move(scene), how, {Purpose::forward_dynamics, Purpose::linearisation}, options);
}

/// What acts on the mechanism: ideal drives or not.
struct Plant::Drives {
  Plant& plant;

  void take(IdealState<double>&, std::span<const double> tau) const { plant.take(tau); }
  void integrate(IdealState<double>& motion, double t, double length) const {
    plant.hardware_ ? plant.integrate_driven(t, length) : plant.ideal_.integrate(motion, t, length);
  }
};

Plant::Plant(Equations::Workspace dynamics, const PlantSettings& settings, double rate_hz,
             std::span<const double> psi0, std::span<const double> psid0)
    : ideal_{plant_model(settings, dynamics.scene(), rate_hz), std::move(dynamics)},
      rows_(stage_rows(settings.integrator)),
      faults_may_come_(settings.faults.injected),
      state_{.motion = state_at(model(), psi0, psid0)} {
  if (!Hardware::needed(settings)) return;
  hardware_.emplace(settings, ideal_.dynamics().scene(), rate_hz);
  state_.hardware = hardware_->state();
  begin_tick();
}

void Plant::put_back(const PlantState& state) {
  state_ = state;
  if (const auto* faults = this->faults())
    ideal_.dynamics().set_parameters(faults->parameters, faults->friction);
}

void Plant::command(std::span<const double> tau) { take_command(model(), state_.motion, tau, Drives{*this}); }

void Plant::advance() {
  advance_tick(model(), state_.motion, Drives{*this});
  begin_tick();
}

void Plant::take_effect(double offset, std::span<const double> tau) {
  mixloop::take_effect(model(), state_.motion, offset, tau, Drives{*this});
}

void Plant::finish_tick() {
  mixloop::finish_tick(model(), state_.motion, Drives{*this});
  begin_tick();
}

void Plant::lock() {
  const auto n = static_cast<Eigen::Index>(model().n);
  state_.motion.x.segment(n, n).setZero();
  state_.motion.applied.setZero();
  state_.motion.locked = true;
}

void Plant::acceleration(std::span<double> psidd) {
  ideal_.dynamics().evaluate(Purpose::forward_dynamics, {psi(), psid(), applied(), time()}, psidd);
}

void Plant::take(std::span<const double> tau) {
  hardware_ ? take_by_hardware(tau) : ideal_.take(state_.motion, tau);
}

}  // namespace mixloop
