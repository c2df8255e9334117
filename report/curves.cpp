// SPDX-License-Identifier: MIT
#include "report/curves.hpp"

#include <cmath>

#include "loop/position_error.hpp"

namespace mixloop {
namespace {

constexpr double kStanding = 1e-9;  // m/s: below it a path has no direction of its own

}  // namespace

Curves::Curves(std::size_t n, std::size_t m, std::vector<int> axes, double rate_hz, std::size_t capacity)
    : n_(n), axes_(std::move(axes)), rate_hz_(rate_hz) {
  const auto add_numbered = [&](const std::string& name, std::size_t count) {
    for (std::size_t i = 1; i <= count; ++i)
      curves_.push_back({name + "_" + std::to_string(i), Envelope(capacity)});
  };
  for (const char* name : {"psi", "psid", "psi_desired", "tau", "tau_applied", "motor_power"})
    add_numbered(name, n);
  add_numbered("q", m);
  for (const char* kind : {"desired", "actual"})
    for (const char* what : {"position", "velocity", "acceleration"})
      for (const char axis : {'x', 'y', 'z'})
        curves_.push_back({std::string(what) + "_" + axis + "_" + kind, Envelope(capacity)});
  for (const char* name : {"error", "error_x", "error_y", "error_z", "error_along", "error_across",
                           "path_length", "kinetic_energy", "potential_energy", "work", "work_lost", "power",
                           "energy_rate", "power_lost", "command_age"})
    curves_.push_back({name, Envelope(capacity)});
}

void Curves::add(const Tick& tick) {
  next_ = 0;
  for (const auto* values : {&tick.psi, &tick.psid, &tick.psi_desired, &tick.tau, &tick.tau_applied})
    for (const double value : *values) put(value);
  for (std::size_t i = 0; i < n_; ++i) put(tick.tau_applied[i] * tick.psid[i]);
  for (const double value : tick.q) put(value);
  for (const auto* motion : {&tick.desired, &tick.actual})
    for (const auto* vector : {&motion->position, &motion->velocity, &motion->acceleration})
      for (const double value : *vector) put(value);
  put_error(tick);
  put_energy(tick);
  put(tick.command_age);
  ++ticks_;
}

// e = p - p_d; along = e . v_d / |v_d|; across = |e - along v_d / |v_d||
void Curves::put_error(const Tick& tick) {
  const Eigen::Vector3d e = tick.actual.position - tick.desired.position;
  const double error = position_error(tick.actual.position, tick.desired.position, axes_);
  measure(error, tick.t);
  put(error);
  for (const double value : e) put(value);

  const double speed = tick.desired.velocity.norm();
  if (speed > kStanding) heading_ = tick.desired.velocity / speed;
  const double along = e.dot(heading_);
  put(along);
  put((e - along * heading_).norm());

  const double step = (tick.desired.position - place_).norm();
  if (!std::isnan(step)) path_length_ += step;
  if (!std::isnan(tick.desired.position[0])) place_ = tick.desired.position;
  put(std::isnan(tick.desired.position[0]) ? kUnknown : path_length_);
}

// Power and energy rate are means over the tick that has passed; W - (E - E_0) is friction, loads and the
// integrator's error.
void Curves::put_energy(const Tick& tick) {
  const double energy = tick.kinetic_energy + tick.potential_energy;
  if (std::isnan(first_energy_)) first_energy_ = energy - tick.work;
  const double power = (tick.work - work_) * rate_hz_, rate = (energy - energy_) * rate_hz_;
  for (const double value : {tick.kinetic_energy, tick.potential_energy, tick.work,
                             tick.work - (energy - first_energy_), power, rate, power - rate})
    put(value);
  energy_ = energy;
  work_ = tick.work;
}

void Curves::measure(double error, double t) {
  if (std::isnan(error)) return;
  if (!(error <= error_.max)) error_.max = error, error_.time_of_max = t;
  error_.final = error;
  sum_of_squares_ += error * error;
  ++errors_;
}

void Curves::coarsen() {
  for (auto& curve : curves_) curve.envelope.coarsen();
}

TrackingError Curves::tracking_error() const {
  TrackingError error = error_;
  if (errors_ > 0) error.rms = std::sqrt(sum_of_squares_ / static_cast<double>(errors_));
  return error;
}

}  // namespace mixloop
