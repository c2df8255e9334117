// SPDX-License-Identifier: MIT
#include "plant/plant.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plant/tick.hpp"

namespace mixloop {
namespace {

Equations::Options options_of(const PlantSettings& settings) {
  return {.friction_factor = settings.faults.change_friction()};
}

}  // namespace

std::shared_ptr<const Equations> plant_equations(std::shared_ptr<const Scene> scene, Evaluation how,
                                                 const PlantSettings& settings, EquationsShelf* shelf) {
  const Equations::Options options = options_of(settings);
  if (settings.partitions) {  // whose scenes are each experiment's own
    scene = settings.partitions->front().scene;
    shelf = nullptr;
  }
  std::vector<Purpose> purposes = {Purpose::forward_dynamics};
  if (facts(settings.integrator).jacobian) purposes.push_back(Purpose::linearisation);
  if (scene->n() > scene->n_u()) purposes.push_back(Purpose::mass_matrix);  // by which HeldMotors go
  return shelved_equations(shelf, scene, how, purposes, options);
}

/// What acts on the mechanism: ideal drives or not.
struct Plant::Drives {
  Plant& plant;

  void take(IdealState<double>&, std::span<const double> tau) const { plant.take(tau); }
  void integrate(IdealState<double>& motion, double t, double length) const {
    if (motion.locked) return plant.integrate_held(t, length);
    plant.hardware_ || plant.is_switched() ? plant.integrate_driven(t, length)
                                           : plant.ideal_.integrate(motion, t, length);
  }
};

Plant::Plant(Equations::Workspace dynamics, const PlantSettings& settings, double rate_hz,
             std::span<const double> psi0, std::span<const double> psid0)
    : ideal_{plant_model(settings, dynamics.scene(), rate_hz), std::move(dynamics)},
      rows_(stage_rows(settings.integrator)),
      faults_may_come_(settings.faults.injected),
      measured_(settings.sensors.measured(model().n)),
      state_{.motion = state_at(model(), psi0, psid0)} {
  if (model().n > model().n_u) {
    held_.emplace(static_cast<Eigen::Index>(model().n), static_cast<Eigen::Index>(model().n_u));
    held_rates_.resize(state_.motion.x.size());
  }
  ideal_.dynamics().hold_anchor();
  if (settings.partitions) {
    partitions_.emplace(settings.partitions, equations().evaluation(),
                        std::initializer_list<Purpose>{Purpose::forward_dynamics}, options_of(settings),
                        parameters_of(settings, declared()));
    state_.loops = stage_ = partitions_->motion();
  }
  state_.anchor.resize(partitions_ ? partitions_->longest_anchor()
                                   : ideal_.dynamics().closures().anchor().size());
  follow_closures();
  if (!Hardware::needed(settings)) return;
  hardware_.emplace(settings, declared(), rate_hz);
  state_.hardware = hardware_->state();
  begin_tick();
}

void Plant::put_back(const PlantState& state) {
  if (partitions_) {
    partitions_->exchange(ideal_.dynamics(), state.loops.partition);
    stage_.partition = state.loops.partition;
  }
  state_ = state;
  if (auto& closures = ideal_.dynamics().closures())
    closures.put_back(std::span(state_.anchor).first(closures.anchor().size()));
  if (const auto* faults = this->faults()) set_parameters(*faults);
}

void Plant::set_parameters(const Faults::State& faults) {
  ideal_.dynamics().set_parameters(faults.parameters, faults.friction);
  if (partitions_) partitions_->set_parameters(faults.parameters, faults.friction);
}

// At every tick, and nowhere else: all stages and the Jacobian of a tick start from its beginning, so that
// whoever goes through it again gets the same bytes.
void Plant::follow_closures() {
  auto& closures = ideal_.dynamics().closures();
  if (!closures) return;
  is_closed_ = closures.accept(state_.motion.psi(), time()) == Status::ok;
  if (partitions_) follow_partitions();
  const auto anchor = closures.anchor();
  std::fill(std::copy(anchor.begin(), anchor.end(), state_.anchor.begin()), state_.anchor.end(), 0.0);
}

std::optional<ClosureWatch> Plant::closures() const {
  const auto& closures = ideal_.dynamics().closures();
  if (!closures) return std::nullopt;
  return closures.watch();
}

std::string Plant::no_way_on() const {
  const auto watch = closures();
  if (!watch || (is_closed_ && !watch->is_singular())) return {};
  const Scene& scene = equations().scene();
  const auto& independent = declared().independent;
  const auto& block = scene.blocks[watch->worst()];
  std::string pose;
  for (std::size_t i = 0; i < independent.size(); ++i)
    pose += fmt::format(", {} = {:.6g}", independent[i].name, psi()[i]);
  return fmt::format(
      "the closure '{}' {} at {:.6g} s{} (condition {:.3g})",
      scene.closures[static_cast<std::size_t>(block.rows[0].closure)].name,
      is_closed_ ? "is at a singular pose" : "can't be solved beyond a singular pose or its reach", time(),
      pose, watch->conditions[watch->worst()]);
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
  auto& motion = state_.motion;
  const auto n = static_cast<Eigen::Index>(model().n);
  if (held_) {
    held_->look(ideal_.dynamics(), motion.psi(), time() + motion.within);
    held_->hold(motion.x.segment(n, n));
  } else {
    motion.x.segment(n, n).setZero();
  }
  state_.loops.rate.setZero();
  motion.applied.setZero();
  motion.locked = true;
}

/// What is free moves on; nothing else does.
void Plant::integrate_held(double t, double length) {
  if (!held_) return;
  auto& motion = state_.motion;
  const auto n = static_cast<Eigen::Index>(model().n);
  const auto look = [&](double at, const Vector& x, Vector& dx) {
    ideal_.rate_of(motion, at, x, dx);
    held_->look(ideal_.dynamics(), {x.data(), model().n}, at);
  };
  const auto rate = [&](double after, const Vector& x, Vector& dx) {
    look(t + after, x, dx);
    held_->hold(dx.segment(n, n));
  };
  const auto linear = [&](double after, const Vector& x, auto& jacobian) {
    look(t + after, x, held_rates_);
    motion.applied = held_->torque(held_rates_.segment(n, n));
    ideal_.linearise(motion, t + after, x, jacobian);
    motion.applied.setZero();
    held_->hold(jacobian.by_q);
    held_->hold(jacobian.by_v);
    held_->hold(jacobian.by_t);
  };
  ideal_.integrate_by(motion, length, rate, linear);
}

void Plant::acceleration(std::span<double> zdd) {
  const auto& motion = state_.motion;
  ideal_.dynamics().evaluate(Purpose::forward_dynamics, {motion.psi(), motion.psid(), applied(), time()},
                             zdd);
}

void Plant::take(std::span<const double> tau) {
  hardware_ ? take_by_hardware(tau) : ideal_.take(state_.motion, tau);
}

}  // namespace mixloop
