// SPDX-License-Identifier: MIT
#include "report/mechanism.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/constraints.hpp"

namespace mixloop {

// The programs are interpreted: no compiler is needed to look at a log.
Mechanism::Mechanism(std::shared_ptr<const Scene> scene, std::vector<double> parameters)
    : scene_(std::move(scene)),
      model_(make_model<double>(scene_, std::span<const double>(parameters))),
      ws_(model_),
      dynamics_(equations_of(scene_, Evaluation::interpreter,
                             {Purpose::forward_dynamics, Purpose::end_effector, Purpose::energy}),
                parameters),
      psidd_(dynamics_.outputs(Purpose::forward_dynamics)),
      hand_(dynamics_.outputs(Purpose::end_effector)) {}

void Mechanism::complete(Tick& tick) {
  if (tick.psi.empty() || std::ranges::any_of(tick.psi, [](double psi) { return std::isnan(psi); })) return;
  coordinates<double>(model_, std::span<const double>(tick.psi), tick.t, ws_);
  tick.q.assign(ws_.q.begin(), ws_.q.end());
  if (!scene_->end_effector.named) {
    tick.actual = {};  // TRUTH has the ground's origin in its place
  } else if (std::isnan(tick.actual.position[0])) {
    dynamics_.evaluate(Purpose::forward_dynamics, {tick.psi, tick.psid, tick.tau_applied, tick.t}, psidd_);
    dynamics_.evaluate(Purpose::end_effector, {tick.psi, tick.psid, psidd_, tick.t}, hand_);
    tick.actual.position = Eigen::Map<const Eigen::Vector3d>(hand_.data());
    tick.actual.velocity = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 3);
    tick.actual.acceleration = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 6);
  }
  if (!std::isnan(tick.kinetic_energy)) return;
  double energy[2];
  dynamics_.evaluate(Purpose::energy, {.psi = tick.psi, .psid = tick.psid, .t = tick.t}, energy);
  tick.kinetic_energy = energy[0];
  tick.potential_energy = energy[1];
}

}  // namespace mixloop
