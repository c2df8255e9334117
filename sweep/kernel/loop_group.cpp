// SPDX-License-Identifier: MIT
#include "sweep/kernel/loop_group.hpp"

#include <cmath>

#include "notation/sha256.hpp"
#include "plant/hardware.hpp"
#include "plant/plant_model.hpp"

namespace mixloop {

using mixloop_loop::Common, mixloop_loop::Each, mixloop_loop::Told;

namespace {

bool takes_mass(Law law) { return law == Law::pd_feedforward || law == Law::computed_torque; }
bool takes_bias(Law law) { return law == Law::pd_gravity || law == Law::computed_torque; }

}  // namespace

KernelParts parts_of(const Experiment& experiment) {
  const Law law = experiment.controller.law;
  return {.plant = experiment.scene,
          .controller = experiment.controller_scene,
          .feedforward = takes_mass(law),
          .bias = takes_bias(law),
          .sensors = experiment.plant.sensors.any(),
          .drives = experiment.plant.actuators.any()};
}

bool are_alike(const PreparedRun& a, const PreparedRun& b) {
  const Experiment &x = a.experiment, &y = b.experiment;
  return a.plan == b.plan && parts_of(x) == parts_of(y) && x.controller.law == y.controller.law &&
         x.controller.feedforward_at == y.controller.feedforward_at && x.plant.substeps == y.plant.substeps &&
         x.rate_hz == y.rate_hz && x.plant.sensors.differentiated == y.plant.sensors.differentiated;
}

LoopGroup::LoopGroup(std::span<const PreparedRun* const> runs, const LoopKernel& kernel,
                     const std::vector<double>& references, const Telling& telling)
    : runs_(runs), telling_(telling), plan_(*runs[0]->plan), n_(plan_.n_u()), references_(references) {
  const std::size_t count = runs.size();
  for (auto* rows : {&psi0_, &kp_, &kv_, &torque_limit_, &most_torque_})
    *rows = Rows(static_cast<std::size_t>(n_), count);
  for (std::size_t p = 0; p < 4; ++p) constants_[p] = Rows(kernel.constants(p), count);
  drives_ = Rows(static_cast<std::size_t>(mixloop_loop::kDriveNumbers * n_), count);
  sensors_ = Rows(static_cast<std::size_t>(mixloop_loop::kSensorNumbers * n_), count);
  sensor_delay_ = Rows(static_cast<std::size_t>(n_), count);
  std::size_t longest = 0;
  for (std::size_t r = 0; r < count; ++r) longest = std::max(longest, take(r, kernel));
  ring_ticks_ = static_cast<int>(longest) + 2;
  ring_ = Rows(static_cast<std::size_t>(ring_ticks_ * n_), count);
  sensor_ring_ = Rows(static_cast<std::size_t>(sensor_ticks_ * 2 * n_), count);
  if (telling.hashes) trajectory_ = Rows(static_cast<std::size_t>((plan_.ticks() + 1) * 3 * n_), count);
  kernel.run(common(), each(), told());
}

std::vector<double> references_of(const Plan& plan) {
  std::vector<double> rows;
  rows.reserve(static_cast<std::size_t>(plan.ticks() + 1) * reference_size(plan.n_u()));
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    const Reference at = plan.at(k);
    for (const auto* values : {&at.psi, &at.psid, &at.psidd})
      rows.insert(rows.end(), values->begin(), values->end());
    for (const auto* values : {&at.position, &at.velocity, &at.acceleration})
      rows.insert(rows.end(), values->begin(), values->end());
  }
  return rows;
}

/// How many ticks its command is late.
std::size_t LoopGroup::take(std::size_t run, const LoopKernel& kernel) {
  const Experiment& experiment = runs_[run]->experiment;
  const PlantModel model = plant_model(experiment.plant, *experiment.scene, experiment.rate_hz);
  psi0_.put(run, plan_.at(0).psi);
  kp_.put(run, experiment.controller.kp);
  kv_.put(run, experiment.controller.kv);
  for (std::size_t i = 0; i < model.n_u; ++i)
    torque_limit_.at(i, run) = model.torque_limit.empty() ? HUGE_VAL : model.torque_limit[i];
  error_limit_.at(0, run) = experiment.position_error_limit;
  delay_ticks_.at(0, run) = static_cast<double>(model.delay_ticks);
  delay_rest_.at(0, run) = model.delay_rest;
  for (std::size_t p = 0; p < 4; ++p) {
    std::vector<double> k(kernel.constants(p));
    const bool of_plant = p == 0 || p == 3;
    kernel.set_up(p, of_plant ? experiment.plant_parameters : experiment.controller_parameters, k.data());
    constants_[p].put(run, k);
  }
  if (Hardware::needed(experiment.plant)) take_hardware(run);
  return model.delay_ticks;
}

void LoopGroup::take_hardware(std::size_t run) {
  const Experiment& experiment = runs_[run]->experiment;
  const Hardware hardware(experiment.plant, *experiment.scene, experiment.rate_hz);
  const auto n = static_cast<std::size_t>(n_);
  if (const auto& actuators = hardware.actuators)
    for (std::size_t i = 0; i < n; ++i) {
      const auto& drive = actuators->drives()[i];
      std::size_t what = 0;
      for (const double number :
           {drive.rate, drive.lag, drive.ripple, drive.per_turn, drive.viscous, drive.coulomb, drive.smooth})
        drives_.at(what++ * n + i, run) = number;
    }
  if (const auto& sensors = hardware.sensors) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto& channel = sensors->channels()[i];
      std::size_t what = 0;
      for (const double number : {channel.resolution, channel.noise, channel.bias})
        sensors_.at(what++ * n + i, run) = number;
      sensor_delay_.at(i, run) = static_cast<double>(channel.delay);
      sensor_ticks_ = std::max(sensor_ticks_, static_cast<int>(channel.delay) + 1);
    }
    velocity_share_.at(0, run) = sensors->velocity_share();
    seeds_[run] = experiment.plant.seed;
  }
}

Common LoopGroup::common() const {
  const Experiment& experiment = runs_[0]->experiment;
  const Law law = experiment.controller.law;
  Common common{.ticks = plan_.ticks(),
                .start_tick = plan_.start_tick(),
                .rate = experiment.rate_hz,
                .tick_length = 1.0 / experiment.rate_hz,
                .substeps = experiment.plant.substeps,
                .feedforward = takes_mass(law),
                .bias = takes_bias(law),
                .at_desired = experiment.controller.feedforward_at == FeedforwardAt::desired,
                .at_rest = law == Law::pd_gravity,
                .axes = {},
                .differentiated = experiment.plant.sensors.differentiated,
                .runs = static_cast<int>(runs_.size()),
                .settled_within = telling_.settled_within.value_or(-1),
                .references = references_.data()};
  for (const int axis : experiment.scene->end_effector.axes) common.axes[axis] = 1;
  return common;
}

Each LoopGroup::each() {
  return {.psi0 = psi0_.data(),
          .kp = kp_.data(),
          .kv = kv_.data(),
          .torque_limit = torque_limit_.data(),
          .error_limit = error_limit_.data(),
          .delay_ticks = delay_ticks_.data(),
          .delay_rest = delay_rest_.data(),
          .plant_constants = constants_[0].data(),
          .mass_constants = constants_[1].data(),
          .bias_constants = constants_[2].data(),
          .hand_constants = constants_[3].data(),
          .drives = drives_.data(),
          .sensors = sensors_.data(),
          .sensor_delay = sensor_delay_.data(),
          .velocity_share = velocity_share_.data(),
          .seeds = seeds_.data()};
}

Told LoopGroup::told() {
  const std::size_t runs = runs_.size();
  double* const at = told_.data();
  return {.ticks_recorded = at,
          .most_error = at + runs,
          .most_error_tick = at + 2 * runs,
          .last_error = at + 3 * runs,
          .squares = at + 4 * runs,
          .errors = at + 5 * runs,
          .settled_tick = at + 6 * runs,
          .most_torque = most_torque_.data(),
          .trajectory = telling_.hashes ? trajectory_.data() : nullptr,
          .ring = ring_.data(),
          .ring_ticks = ring_ticks_,
          .sensor_ring = sensor_ring_.data(),
          .sensor_ticks = sensor_ticks_};
}

Measures LoopGroup::measures(std::size_t run) {
  const double rate = runs_[run]->experiment.rate_hz;
  const auto told = [&](std::size_t i) { return told_.at(i, run); };
  const auto recorded = static_cast<std::int64_t>(told(0));
  Measures out;
  out.max_position_error = told(1);
  out.time_of_max_position_error = told(2) / rate;
  out.final_position_error = told(3);
  if (told(5) > 0) out.rms_position_error = std::sqrt(told(4) / told(5));
  out.settled_at = told(6) / rate;
  out.max_torque = Vector(n_);
  for (int i = 0; i < n_; ++i) out.max_torque[i] = most_torque_.at(static_cast<std::size_t>(i), run);
  out.ticks = std::max<std::int64_t>(recorded - 1, 0);
  if (recorded <= plan_.ticks()) out.diverged_at = told(0) / rate;
  if (!telling_.hashes || recorded == 0) return out;
  Sha256 hash;
  const auto numbers = static_cast<std::size_t>(3 * n_);
  std::vector<double> row(numbers + 1);
  for (std::size_t k = 0; k < static_cast<std::size_t>(recorded); ++k) {
    row[0] = static_cast<double>(k) / rate;
    for (std::size_t i = 0; i < numbers; ++i) row[i + 1] = trajectory_.at(k * numbers + i, run);
    hash.add(std::span<const double>(row));
  }
  out.trajectory_sha256 = hash.hex();
  return out;
}

}  // namespace mixloop
