// SPDX-License-Identifier: MIT
#include "loop/simulate.hpp"

#include "notation/errors.hpp"

namespace mixloop {

void require_start(const GuardedController& controller, std::span<const double> psi, const Plan& plan) {
  if (!plan.has_path()) return;
  const std::string refusal = controller.start_refusal(psi, plan.at(0));
  if (!refusal.empty()) throw RunFault("not_at_start", refusal);
}

void simulate(RecordedPlant& run, const std::function<bool(std::int64_t k)>& go_on) {
  GuardedController controller = make_guarded_controller(run.experiment());
  require_start(controller, run.plant().psi(), run.plan());
  const auto law = [&](const Measurement& now, const Reference& desired, std::span<double> tau) {
    controller.torque(now, desired, tau);
  };
  simulate(run, law, go_on);
}

void simulate(RecordedPlant& run, const TorqueLaw& law, const std::function<bool(std::int64_t k)>& go_on) {
  const Plan& plan = run.plan();
  const Plant& plant = run.plant();
  Vector torque = Vector::Zero(plan.n_u());
  const std::span<const double> tau = span_of(std::as_const(torque));
  const auto control = [&](int stage, double t, std::span<const double> psi, std::span<const double> psid,
                           std::span<double> out) {
    law({psi, psid, t}, plan.at_stage(plant.tick(), stage), out);
  };
  const auto continuously = [&](Plant& it) { it.advance_continuously(control); };
  const auto before_end = [&](std::int64_t k) { return k < plan.ticks(); };
  if (!run.begin()) return;
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    if (!go_on(k)) return run.recorder().interrupted();
    law(run.measure(), plan.at(k), span_of(torque));
    if (!(run.experiment().plant.continuous ? run.lockstep_tick(tau, {}, before_end, continuously)
                                            : run.lockstep_tick(tau, {}, before_end)))
      return;
  }
}

}  // namespace mixloop
