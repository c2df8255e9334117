// SPDX-License-Identifier: MIT
#include "loop/recorder.hpp"

#include <algorithm>
#include <cmath>

#include "loop/energy_balance.hpp"
#include "loop/free_memory.hpp"
#include "loop/position_error.hpp"

namespace mixloop {
namespace {

/// The numbers of a LoopMotion.
std::size_t loop_numbers(const Experiment& experiment) {
  const auto& partitions = experiment.plant.partitions;
  if (!partitions) return 0;
  const Scene& declared = *partitions->front().scene;
  return 1 + 2 * (declared.started.size() + declared.independent.size());
}

/// `!(a <= b)` holds also where b was never measured.
void raise(double& most, double value) {
  if (!(value <= most)) most = value;
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

std::size_t Recorder::bytes_a_tick(const Experiment& experiment) {
  const Scene& scene = *experiment.scene;
  return sizeof(double) *
         (2 * scene.independent.size() + 2 * scene.motors().size() + 1 + loop_numbers(experiment));
}

Recorder::Recorder(const Experiment& experiment, const Plan& plan, const RecorderSettings& settings)
    : plan_(plan),
      kinematics_(
          equations_for(experiment, experiment.scene, {Purpose::end_effector}, {.position_alone = true}),
          experiment.plant_parameters),
      axes_(experiment.scene->end_effector.axes),
      n_(experiment.scene->independent.size()),
      n_u_(experiment.scene->motors().size()),
      loops_(loop_numbers(experiment)),
      rate_hz_(experiment.rate_hz),
      limit_(experiment.position_error_limit),
      kept_(settings.keeps_ticks ? plan.ticks() + 1 : 0),
      rows_(static_cast<std::size_t>(kept_ + 2) * width(), settings.keeps_ticks ? free_memory() : HUGE_VAL),
      conditions_{-1, 1},
      zero_(n_, 0.0),
      hand_(kinematics_.outputs(Purpose::end_effector)),
      settled_within_(settings.settled_within) {
  const auto& end_effector = experiment.scene->end_effector;
  measures_.follows_path = plan.has_path() && end_effector.named;
  measures_.is_oriented = measures_.follows_path && end_effector.is_oriented();
  if (measures_.is_oriented) orientation_.emplace(experiment.scene, experiment.plant_parameters);
  if (experiment.path.is_of_motors()) {
    motor_error_ = Vector::Zero(experiment.scene->n_u());
    motor_error_limit_ = experiment.limits.motor_error;
    measures_.max_motor_error = Vector::Constant(experiment.scene->n_u(), kNeverMeasured);
  }
  measures_.max_torque = Vector::Constant(experiment.scene->n_u(), kNeverMeasured);
  tells_final_ = !measures_.follows_path || experiment.expect.bounds_on("final_psi");
  const bool tells_energy = !plan.has_path() || experiment.expect.bounds_on("energy_drift");
  if (tells_energy && other_work_in(experiment).empty()) {
    measures_.energy_drift = kNeverMeasured;
    if (settings.knows_work && loops_ > 0)
      switched_energy_.emplace(experiment.plant.partitions, told_by(experiment),
                               std::initializer_list<Purpose>{Purpose::energy}, Equations::Options{},
                               experiment.plant_parameters);
    else if (settings.knows_work)
      energy_.emplace(equations_for(experiment, experiment.scene, {Purpose::energy}),
                      experiment.plant_parameters);
    if (switched_energy_) hand_loops_ = switched_energy_->motion();
  }
  const auto& parameters = experiment.plant_parameters;
  conditions_.insert(conditions_.end(), parameters.begin(), parameters.end());
  row_of_conditions_ = conditions_.size();
  // A fault begins and ends; injected ones, more of which than wait at a time come seldom.
  const std::size_t faults =
      experiment.plant.faults.scheduled.size() + (experiment.plant.faults.injected ? kInjectedKept : 0);
  conditions_.reserve(row_of_conditions_ * (1 + 2 * faults));
}

void Recorder::note_changes(std::int64_t k, const Faults::State& faults) {
  if (faults.changed_at != k) return;
  energy_changed_ = true;
  const bool full = conditions_.size() + row_of_conditions_ > conditions_.capacity();
  const bool same_tick = conditions_[conditions_.size() - row_of_conditions_] == static_cast<double>(k);
  if (full || same_tick) conditions_.resize(conditions_.size() - row_of_conditions_);
  conditions_.push_back(static_cast<double>(k));
  conditions_.push_back(faults.friction);
  conditions_.insert(conditions_.end(), faults.parameters.begin(), faults.parameters.end());
}

Recorder::Conditions Recorder::conditions(std::int64_t k) const {
  std::size_t at = conditions_.size() - row_of_conditions_;
  while (at > 0 && conditions_[at] > static_cast<double>(k)) at -= row_of_conditions_;
  return {static_cast<std::int64_t>(conditions_[at]),
          {conditions_.data() + at + 2, row_of_conditions_ - 2},
          conditions_[at + 1]};
}

/// Of a path of the motors, how far each is from its reference: whether that is past its limit.
bool Recorder::motors_are_off(std::int64_t k, std::span<const double> psi) {
  if (!measures_.max_motor_error) return false;
  const Reference reference = plan_.at(k);
  bool off = false;
  for (Eigen::Index i = 0; i < motor_error_.size(); ++i) {
    const auto motor = static_cast<std::size_t>(i);
    motor_error_[i] = std::abs(psi[motor] - reference.psi[i]);
    off = off || (!motor_error_limit_.empty() && !(motor_error_[i] <= motor_error_limit_[motor]));
  }
  return off && judged(k);
}

bool Recorder::state(std::int64_t k, std::span<const double> psi, std::span<const double> psid, double work) {
  if (!all_finite(psi) || !all_finite(psid) || !std::isfinite(work)) return diverged(k);
  if (motors_are_off(k, psi)) return diverged(k);
  if (measures_.follows_path) {
    kinematics_.evaluate(Purpose::end_effector, {psi, psid, zero_, time(k)}, hand_);
    error_ =
        mixloop::position_error(Eigen::Map<const Eigen::Vector3d>(hand_.data()), plan_.at(k).position, axes_);
    if (judged(k) && !(error_ <= limit_)) return diverged(k);
  }

  double* to = row(k);
  std::copy(psi.begin(), psi.end(), to);
  std::copy(psid.begin(), psid.end(), to + n_);
  to[2 * n_ + 2 * n_u_] = work;
  return true;
}

bool Recorder::state(std::int64_t k, std::span<const double> psi, std::span<const double> psid, double work,
                     const LoopMotion& loops, std::int64_t switches) {
  if (!state(k, psi, psid, work)) return false;
  double* to = row(k) + 2 * n_ + 2 * n_u_ + 1;
  *to++ = loops.partition;
  to = std::copy(loops.at.begin(), loops.at.end(), to);
  std::copy(loops.rate.begin(), loops.rate.end(), to);
  measures_.switches = switches;
  return true;
}

void Recorder::loops(std::int64_t k, LoopMotion& motion) const {
  const double* from = row(k) + 2 * n_ + 2 * n_u_ + 1;
  motion.partition = static_cast<int>(*from++);
  std::copy_n(from, motion.at.size(), motion.at.data());
  std::copy_n(from + motion.at.size(), motion.rate.size(), motion.rate.data());
}

void Recorder::closures(const ClosureWatch& watch) {
  const double condition = watch.conditions[watch.worst()];
  measures_.closure_residual = std::max(measures_.closure_residual.value_or(0), watch.residual);
  measures_.closure_condition = std::max(measures_.closure_condition.value_or(1), condition);
}

bool Recorder::no_way_on(std::int64_t k, std::string why) {
  measures_.no_way_on = std::move(why);
  return diverged(k);
}

bool Recorder::command(std::int64_t k, std::span<const double> tau, std::span<const double> applied) {
  if (!all_finite(tau)) return diverged(k);
  double* to = row(k);
  std::copy(tau.begin(), tau.end(), to + 2 * n_);
  std::copy(applied.begin(), applied.end(), to + 2 * n_ + n_u_);
  if (k > plan_.ticks()) return true;
  recorded_ = k + 1;
  if (judged(k)) measure(k, tau);
  return true;
}

void Recorder::measure(std::int64_t k, std::span<const double> tau) {
  for (std::size_t i = 0; i < tau.size(); ++i)
    raise(measures_.max_torque[static_cast<Eigen::Index>(i)], std::abs(tau[i]));
  if (energy_ || switched_energy_) measure_energy(k);
  if (plan_.has_path() && k >= plan_.start_tick()) measure_path(k);
}

void Recorder::measure_path(std::int64_t k) {
  for (Eigen::Index i = 0; i < motor_error_.size(); ++i)
    raise((*measures_.max_motor_error)[i], motor_error_[i]);
  if (orientation_)
    raise(measures_.max_orientation_error, orientation_->at(psi(k), span_of(plan_.at(k).psi), time(k)));
  if (!measures_.follows_path) return;
  if (!(error_ <= measures_.max_position_error)) {
    measures_.max_position_error = error_;
    measures_.time_of_max_position_error = time(k);
  }
  measures_.final_position_error = error_;
  if (settled_within_ && !(error_ <= *settled_within_))
    measures_.settled_at = kNeverMeasured;
  else if (settled_within_ && !(measures_.settled_at <= time(k)))
    measures_.settled_at = time(k);
  sum_of_squares_ += error_ * error_;
  ++errors_;
}

/// (E - E_0 - W) at its largest, over E at its largest.
void Recorder::measure_energy(std::int64_t k) {
  double parts[2];
  if (switched_energy_) {
    loops(k, hand_loops_);
    switched_energy_->evaluate(Purpose::energy, hand_loops_, {}, time(k), parts);
  } else {
    energy_->evaluate(Purpose::energy, {.psi = psi(k), .psid = psid(k), .t = time(k)}, parts);
  }
  const double energy = parts[0] + parts[1];
  if (!std::exchange(energy_begun_, true)) first_energy_ = energy - work(k);
  largest_energy_ = std::max(largest_energy_, std::abs(energy));
  largest_imbalance_ = std::max(largest_imbalance_, std::abs(energy - first_energy_ - work(k)));
  if (energy_changed_)
    measures_.energy_drift = kNeverMeasured;
  else  // what never has any energy drifts by nothing
    measures_.energy_drift = largest_imbalance_ > 0 ? largest_imbalance_ / largest_energy_ : 0;
}

std::optional<Vector> Recorder::final_psi() const {
  if (!tells_final_) return std::nullopt;
  const std::int64_t last = std::min(recorded_, safe_from_) - 1;
  if (last < 0) return Vector::Constant(static_cast<Eigen::Index>(n_), kNeverMeasured);
  return map_of(psi(last));
}

bool Recorder::diverged(std::int64_t k) {
  measures_.diverged_at = time(k);
  return false;
}

void Recorder::interrupted() { measures_.interrupted_at = time(std::max<std::int64_t>(recorded_ - 1, 0)); }

void Recorder::made_safe(std::int64_t k) {
  safe_from_ = k;
  measures_.safe_at = time(k);
}

Measures Recorder::measures() const {
  Measures result = measures_;
  result.ticks = std::max<std::int64_t>(recorded_ - 1, 0);
  result.final_psi = final_psi();
  if (errors_ > 0) result.rms_position_error = std::sqrt(sum_of_squares_ / static_cast<double>(errors_));
  if (recorded_ > kept_) return result;
  Sha256 hash;
  for (std::int64_t k = 0; k < recorded_; ++k) {
    const double t = time(k);
    hash.add(std::span<const double>(&t, 1));
    for (const auto& values : {psi(k), psid(k), commanded(k)}) hash.add(values);
  }
  if (recorded_ > 0) result.trajectory_sha256 = hash.hex();
  return result;
}

}  // namespace mixloop
