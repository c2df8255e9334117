// SPDX-License-Identifier: MIT
#include "loop/simulate.hpp"

namespace mixloop {

void simulate(const Experiment& experiment, const Plan& plan, Recorder& recorder,
              const std::function<bool(std::int64_t k)>& go_on) {
  Plant plant = make_plant(experiment, plan);
  Controller controller = make_controller(experiment);
  Vector tau = Vector::Zero(experiment.scene->n());
  const auto control = [&](int stage, double t, std::span<const double> psi, std::span<const double> psid,
                           std::span<double> out) {
    controller.torque(psi, psid, plan.at_stage(plant.tick(), stage), t, out);
  };
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    if (!recorder.state(k, plant.psi(), plant.psid(), plant.work())) return;
    if (!go_on(k)) return recorder.interrupted();
    controller.torque(plant.psi(), plant.psid(), plan.at(k), plant.time(), span_of(tau));
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
