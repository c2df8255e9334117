// SPDX-License-Identifier: MIT
#include "report/curves.hpp"

#include <fmt/format.h>

#include <cmath>

#include "loop/position_error.hpp"

namespace mixloop {
namespace {

constexpr double kStanding = 1e-9;  // m/s: below it a path has no direction of its own

}  // namespace

Curves::Curves(std::vector<int> axes, double rate_hz, std::size_t capacity)
    : axes_(std::move(axes)), rate_hz_(rate_hz), capacity_(capacity) {}

/// The value of the next curve, which the first tick names.
template <class... Parts>
void Curves::put(double value, const char* name, const Parts&... parts) {
  if (next_ == curves_.size())
    curves_.push_back({fmt::format(fmt::runtime(name), parts...), Envelope(capacity_)});
  curves_[next_++].envelope.add(value);
}

void Curves::add(const Tick& tick) {
  next_ = 0;
  for (const auto& [what, values] : kByCoordinate)
    for (std::size_t i = 0; i < (tick.*values).size(); ++i) put((tick.*values)[i], "{}_{}", what, i + 1);
  for (std::size_t i = 0; i < tick.tau_applied.size(); ++i)
    put(tick.tau_applied[i] * tick.psid[i], "motor_power_{}", i + 1);
  for (std::size_t j = 0; j < tick.q.size(); ++j) put(tick.q[j], "q_{}", j + 1);
  for (const auto& [kind, motion] : kMotions)
    for (const auto& [what, vector] : kOfAMotion)
      for (int axis = 0; axis < 3; ++axis)
        put((tick.*motion.*vector)[axis], "{}_{}_{}", what, "xyz"[axis], kind);
  put_error(tick);
  put_energy(tick);
  put(tick.command_age, "command_age");
  ++ticks_;
}

// e = p - p_d; along = e . v_d / |v_d|; across = |e - along v_d / |v_d||
void Curves::put_error(const Tick& tick) {
  const Eigen::Vector3d e = tick.actual.position - tick.desired.position;
  const double error = position_error(tick.actual.position, tick.desired.position, axes_);
  if (tick.judged) measure(error, tick.t);
  put(error, "error");
  for (int axis = 0; axis < 3; ++axis) put(e[axis], "error_{}", "xyz"[axis]);

  const double speed = tick.desired.velocity.norm();
  if (speed > kStanding) heading_ = tick.desired.velocity / speed;
  const double along = e.dot(heading_);
  put(along, "error_along");
  put((e - along * heading_).norm(), "error_across");

  const double step = (tick.desired.position - place_).norm();
  if (!std::isnan(step)) path_length_ += step;
  if (!std::isnan(tick.desired.position[0])) place_ = tick.desired.position;
  put(std::isnan(tick.desired.position[0]) ? kUnknown : path_length_, "path_length");
}

// Power and energy rate are means over the tick that has passed; W - (E - E_0) is friction, loads and the
// integrator's error.
void Curves::put_energy(const Tick& tick) {
  const double energy = tick.kinetic_energy + tick.potential_energy;
  if (std::isnan(first_energy_)) first_energy_ = energy - tick.work;
  const double power = (tick.work - work_) * rate_hz_, rate = (energy - energy_) * rate_hz_;
  put(tick.kinetic_energy, "kinetic_energy");
  put(tick.potential_energy, "potential_energy");
  put(tick.work, "work");
  put(tick.work - (energy - first_energy_), "work_lost");
  put(power, "power");
  put(rate, "energy_rate");
  put(power - rate, "power_lost");
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
