// SPDX-License-Identifier: MIT
#include "loop/truth.hpp"

namespace mixloop {
namespace {

std::size_t gives(Purpose purpose, const Experiment& experiment) {
  return output_size(purpose, experiment.scene->n(), experiment.scene->n_u());
}

}  // namespace

TruthReader::Switched::Switched(const Experiment& experiment, Equations::Options options)
    : dynamics(experiment.plant.partitions, told_by(experiment),
               {Purpose::forward_dynamics, Purpose::end_effector, Purpose::energy}, options,
               experiment.plant_parameters),
      showing(std::make_shared<const std::vector<Partition>>(showing_swapped(*experiment.plant.partitions)),
              told_by(experiment), {Purpose::end_effector}, {}, experiment.plant_parameters),
      motion(dynamics.motion()) {}

TruthReader::TruthReader(const Experiment& experiment, const Recorder& recorder)
    : recorder_(recorder),
      brakes_(experiment.deadline.safe_state == SafeState::brake),
      partitions_(experiment.plant.partitions),
      hand_(gives(Purpose::end_effector, experiment)),
      zdd_(gives(Purpose::forward_dynamics, experiment)) {
  const Equations::Options options{.friction_factor = experiment.plant.faults.change_friction()};
  if (partitions_) {
    switched_.emplace(experiment, options);
  } else {
    std::vector<Purpose> purposes = {Purpose::forward_dynamics, Purpose::end_effector, Purpose::energy};
    const int n = experiment.scene->n(), n_u = experiment.scene->n_u();
    if (brakes_ && n > n_u) held_.emplace(n, n_u), purposes.push_back(Purpose::mass_matrix);
    dynamics_.emplace(equations_of(experiment.scene, experiment.evaluation, purposes, options),
                      experiment.plant_parameters);
  }
  truth_.psidd = zdd_;
}

const Truth& TruthReader::at(std::int64_t k) {
  take_conditions(k);
  if (switched_) recorder_.loops(k, switched_->motion);
  evaluate(Purpose::forward_dynamics, k, recorder_.applied(k), zdd_);
  if (brakes_ && k >= recorder_.safe_from()) hold_motors(k);
  evaluate(Purpose::end_effector, k, zdd_, hand_);
  truth_.position = Eigen::Map<const Eigen::Vector3d>(hand_.data());
  truth_.velocity = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 3);
  truth_.acceleration = Eigen::Map<const Eigen::Vector3d>(hand_.data() + 6);
  double energy[2];
  evaluate(Purpose::energy, k, {}, energy);
  truth_.kinetic_energy = energy[0];
  truth_.potential_energy = energy[1];
  truth_.work = recorder_.work(k);
  truth_.psidd = zdd_;
  if (switched_) show_swapped(k);
  return truth_;
}

/// Locked motors don't accelerate, and what is free does as they stand.
void TruthReader::hold_motors(std::int64_t k) {
  Eigen::Map<Vector> zdd(zdd_.data(), static_cast<Eigen::Index>(zdd_.size()));
  if (!held_) {
    zdd.setZero();
    return;
  }
  held_->look(*dynamics_, recorder_.psi(k), recorder_.time(k));
  held_->hold(zdd);
}

/// In the coordinates in use.
void TruthReader::evaluate(Purpose purpose, std::int64_t k, std::span<const double> input,
                           std::span<double> outputs) {
  const double t = recorder_.time(k);
  if (switched_)
    switched_->dynamics.evaluate(purpose, switched_->motion, input, t, outputs);
  else
    dynamics_->evaluate(purpose, {recorder_.psi(k), recorder_.psid(k), input, t}, outputs);
}

void TruthReader::take_conditions(std::int64_t k) {
  const auto conditions = recorder_.conditions(k);
  if (conditions.since == conditions_since_) return;
  conditions_since_ = conditions.since;
  if (!switched_) return dynamics_->set_parameters(conditions.parameters, conditions.friction);
  switched_->dynamics.set_parameters(conditions.parameters, conditions.friction);
  switched_->showing.set_parameters(conditions.parameters, 1);
}

/// The acceleration of the psi that is not independent now.
void TruthReader::show_swapped(std::int64_t k) {
  const LoopMotion& motion = switched_->motion;
  const int swapped = (*partitions_)[static_cast<std::size_t>(motion.partition)].swapped;
  if (swapped < 0) return;
  switched_->showing.evaluate(Purpose::end_effector, motion, zdd_, recorder_.time(k), hand_);
  truth_.psidd[static_cast<std::size_t>(swapped)] = hand_[8];
}

}  // namespace mixloop
