// SPDX-License-Identifier: MIT
#include "loop/truth.hpp"

namespace mixloop {

TruthReader::TruthReader(const Experiment& experiment, const Recorder& recorder)
    : recorder_(recorder),
      dynamics_(equations_of(experiment.scene, experiment.evaluation,
                             {Purpose::forward_dynamics, Purpose::end_effector, Purpose::energy},
                             {.friction_factor = experiment.plant.faults.change_friction()}),
                experiment.plant_parameters),
      hand_(dynamics_.outputs(Purpose::end_effector)) {
  truth_.psidd = dynamics_.outputs(Purpose::forward_dynamics);
}

const Truth& TruthReader::at(std::int64_t k) {
  const auto psi = recorder_.psi(k), psid = recorder_.psid(k);
  const double t = recorder_.time(k);
  const auto conditions = recorder_.conditions(k);
  if (conditions.since != conditions_since_) {
    conditions_since_ = conditions.since;
    dynamics_.set_parameters(conditions.parameters, conditions.friction);
  }
  dynamics_.evaluate(Purpose::forward_dynamics, {psi, psid, recorder_.applied(k), t}, truth_.psidd);
  dynamics_.evaluate(Purpose::end_effector, {psi, psid, truth_.psidd, t}, hand_);
  truth_.position = Eigen::Map<const Eigen::Vector3d>(hand_.data());
  truth_.velocity = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 3);
  truth_.acceleration = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 6);
  double energy[2];
  dynamics_.evaluate(Purpose::energy, {.psi = psi, .psid = psid, .t = t}, energy);
  truth_.kinetic_energy = energy[0];
  truth_.potential_energy = energy[1];
  truth_.work = recorder_.work(k);
  return truth_;
}

}  // namespace mixloop
