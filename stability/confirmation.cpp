// SPDX-License-Identifier: MIT
#include "stability/confirmation.hpp"

#include <cmath>
#include <limits>

#include "notation/long_work.hpp"

namespace mixloop {
namespace {

constexpr double kDisturbance = 1e-6;      // rad or m
constexpr double kAboveRounding = 0x1p20;  // of a motor's position, at least
constexpr int kMostTicks = 20'000;

/// Of each motor.
Vector disturbance(const Reference& at) {
  const double roundoff = std::numeric_limits<double>::epsilon();
  return (kAboveRounding * roundoff * at.psi.cwiseAbs()).cwiseMax(kDisturbance);
}

PsiMotion at_rest(const Experiment& experiment, const Reference& reference) {
  PsiMotion still = wanted_state(experiment.controller, *experiment.scene, reference);
  still.psid.setZero();
  still.psidd.setZero();
  return still;
}

/// What isn't measured no law takes: here it is, as Holding hands on the whole state.
Experiment all_measured(Experiment experiment) {
  experiment.plant.sensors = {};
  return experiment;
}

/// One robot that holds the reference.
class Holding {
 public:
  Holding(const Experiment& experiment, const Reference& start, const Sampling& sampling, const Vector& off)
      : start_(start),
        controller_(make_controller(all_measured(experiment))),
        plant_(plant_of(experiment, start, sampling, off)) {
    // What the control law lacks of an equilibrium at the reference.
    const auto n_u = start.psi.size();
    tau_ = Vector::Zero(n_u);
    const PsiMotion still = at_rest(experiment, start);
    Vector needed(still.psi.size());
    Equations::Workspace dynamics(
        equations_of(experiment.scene, experiment.evaluation, {Purpose::inverse_dynamics}),
        experiment.plant_parameters);
    dynamics.evaluate(Purpose::inverse_dynamics,
                      {span_of(still.psi), span_of(still.psid), span_of(still.psidd)}, span_of(needed));
    controller_.torque({span_of(still.psi), span_of(still.psid)}, start_, span_of(tau_));
    support_ = needed.head(n_u) - tau_;
  }

  void tick() {
    controller_.torque({plant_.psi(), plant_.psid(), plant_.time()}, start_, span_of(tau_));
    tau_ += support_;
    plant_.command(span_of(std::as_const(tau_)));
    plant_.advance();
  }

  Eigen::Map<const Vector> psi() const { return map_of(plant_.psi()); }

 private:
  static Plant plant_of(const Experiment& experiment, const Reference& start, const Sampling& sampling,
                        const Vector& off) {
    Vector psi = at_rest(experiment, start).psi;
    psi.head(start.psi.size()) += off;
    PlantSettings settings = ideal(experiment.plant);
    settings.command_delay = sampling.delay;
    settings.torque_limit.clear();
    return Plant(
        {plant_equations(experiment.scene, experiment.evaluation, settings), experiment.plant_parameters},
        settings, 1 / sampling.tick, span_of(std::as_const(psi)));
  }

  const Reference start_;
  Controller controller_;
  Plant plant_;
  Vector tau_, support_;
};

}  // namespace

std::string_view name_of(Fate fate) {
  return fate == Fate::decays ? "decays" : fate == Fate::grows ? "grows" : "undecided";
}

Fate fate_of_disturbance(const Experiment& experiment, const Plan& plan, const Sampling& sampling) {
  const Reference start = plan.at(plan.start_tick());
  const Vector beside = disturbance(start);
  Holding disturbed(experiment, start, sampling, beside),
      still(experiment, start, sampling, Vector::Zero(beside.size()));
  int small = 0;  // ticks in a row: an oscillation passes through zero
  for (int k = 0; k < kMostTicks; ++k) {
    work_goes_on();
    disturbed.tick();
    still.tick();
    const Vector off = (disturbed.psi() - still.psi()).head(beside.size());
    const double share = off.cwiseQuotient(beside).cwiseAbs().maxCoeff();
    if (!(share < 1e3)) return Fate::grows;
    small = share < 1e-3 ? small + 1 : 0;
    if (small == 50) return Fate::decays;
  }
  return Fate::undecided;
}

}  // namespace mixloop
