// SPDX-License-Identifier: MIT
#include "loop/simulate.hpp"

#include "loop/measured_state.hpp"
#include "notation/errors.hpp"

namespace mixloop {

void require_start(const GuardedController& controller, std::span<const double> psi, const Plan& plan) {
  const std::string refusal = controller.start_refusal(psi, plan.at(0));
  if (!refusal.empty()) throw RunFault("not_at_start", refusal);
}

void simulate(const Experiment& experiment, const Plan& plan, Recorder& recorder,
              const std::function<bool(std::int64_t k)>& go_on) {
  Plant plant = make_plant(experiment, plan);
  GuardedController controller = make_guarded_controller(experiment);
  require_start(controller, plant.psi(), plan);
  Vector tau = Vector::Zero(experiment.scene->n_u());
  MeasuredState measured(plant);
  const auto control = [&](int stage, double t, std::span<const double> psi, std::span<const double> psid,
                           std::span<double> out) {
    controller.torque({psi, psid, t}, plan.at_stage(plant.tick(), stage), out);
  };
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    recorder.note_changes(k, plant.faults());
    if (!recorder.state(k, plant.psi(), plant.psid(), plant.work())) return;
    if (!go_on(k)) return recorder.interrupted();
    measured.take(plant);
    controller.torque({measured.psi(), measured.psid(), plant.time(), measured.stale()}, plan.at(k),
                      span_of(tau));
    plant.command(span_of(std::as_const(tau)));
    if (!recorder.command(k, span_of(std::as_const(tau)), plant.applied())) return;
    if (k == plan.ticks()) return;
    if (experiment.plant.continuous)
      plant.advance_continuously(control);
    else
      plant.advance();
  }
}

}  // namespace mixloop
