// SPDX-License-Identifier: MIT
#include "sweep/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "dynamics/scene/coordinate_values.hpp"

namespace mixloop {
namespace {

// Numbers of a Measures, some of which it may not have, as one that is never without.
double number_of(const double& value) { return value; }
double number_of(const std::optional<double>& value) { return value.value_or(kNeverMeasured); }
double number_of(const std::optional<std::int64_t>& value) {
  return value ? static_cast<double>(*value) : kNeverMeasured;
}
double number_of(const std::int64_t& value) { return static_cast<double>(value); }

void put(double number, double& value) { value = number; }
void put(double number, std::optional<double>& value) {
  if (!std::isnan(number)) value = number;
}
void put(double number, std::optional<std::int64_t>& value) {
  if (!std::isnan(number)) value = static_cast<std::int64_t>(number);
}
void put(double number, std::int64_t& value) {
  if (!std::isnan(number)) value = static_cast<std::int64_t>(number);
}

}  // namespace

std::string_view name_of(RunEnd end) {
  static constexpr std::string_view kNames[] = {"held",       "missed", "diverged",
                                                "safe_state", "fault",  "refused"};
  return kNames[static_cast<std::size_t>(end)];
}

/// The order of the columns, once: `take(name, unit, value)` with each.
template <class Passed, class Take>
void Columns::go(Passed& m, const Take& take) const {
  if (follows_path_) {
    take("max_position_error", "m", m.max_position_error);
    take("time_of_max_position_error", "s", m.time_of_max_position_error);
    take("final_position_error", "m", m.final_position_error);
    take("rms_position_error", "m", m.rms_position_error);
    if (settles_) take("settled_at", "s", m.settled_at);
  }
  if (is_oriented_) take("max_orientation_error", "rad", m.max_orientation_error);
  for (std::size_t i = 0; i < n_u_ && is_of_motors_; ++i)
    take(fmt::format("max_motor_error[{}]", i), "motor", (*m.max_motor_error)[static_cast<Eigen::Index>(i)]);
  for (std::size_t i = 0; i < n_u_; ++i)
    take(fmt::format("max_torque[{}]", i), "torque", m.max_torque[static_cast<Eigen::Index>(i)]);
  if (!follows_path_) {
    for (std::size_t i = 0; i < n_; ++i)
      take(fmt::format("final_psi[{}]", i), "position", (*m.final_psi)[static_cast<Eigen::Index>(i)]);
    take("energy_drift", "1", m.energy_drift);
  }
  take("diverged_at", "s", m.diverged_at);
  take("safe_at", "s", m.safe_at);
  take("ticks", "1", m.ticks);
  if (!closed_) return;
  take("closure_residual", "1", m.closure_residual);
  take("closure_condition", "1", m.closure_condition);
  if (switches_) take("switches", "1", m.switches);
}

Columns::Columns(const Experiment& experiment, bool settles)
    : follows_path_(experiment.has_path() && experiment.scene->end_effector.named),
      is_oriented_(follows_path_ && experiment.scene->end_effector.is_oriented()),
      is_of_motors_(experiment.path.is_of_motors()),
      settles_(settles),
      closed_(experiment.scene->is_closed()),
      switches_(experiment.plant.partitions != nullptr),
      n_(experiment.scene->independent.size()),
      n_u_(experiment.scene->motors().size()) {
  Measures none;
  none.max_motor_error = Vector::Zero(static_cast<Eigen::Index>(n_u_));
  none.max_torque = Vector::Zero(static_cast<Eigen::Index>(n_u_));
  none.final_psi = Vector::Zero(static_cast<Eigen::Index>(n_));
  std::size_t motor = 0, coordinate = 0, off = 0;
  go(std::as_const(none), [&](const std::string& name, const std::string& unit, const auto&) {
    if (unit == "torque")
      all_.push_back({name, torque_unit(experiment.scene->motors()[motor++].linear)});
    else if (unit == "motor")
      all_.push_back({name, position_unit(experiment.scene->motors()[off++].linear)});
    else if (unit == "position")
      all_.push_back({name, position_unit(experiment.scene->independent[coordinate++].linear)});
    else
      all_.push_back({name, unit});
  });
}

std::vector<double> Columns::values(const Measures& measures) const {
  std::vector<double> values;
  go(measures, [&](const auto&, const auto&, const auto& value) { values.push_back(number_of(value)); });
  return values;
}

Measures Columns::measures(const Outcome& outcome) const {
  Measures measures;
  measures.follows_path = follows_path_;
  measures.max_torque = Vector::Constant(static_cast<Eigen::Index>(n_u_), kNeverMeasured);
  if (is_of_motors_)
    measures.max_motor_error = Vector::Constant(static_cast<Eigen::Index>(n_u_), kNeverMeasured);
  if (!follows_path_) measures.final_psi = Vector::Constant(static_cast<Eigen::Index>(n_), kNeverMeasured);
  auto at = outcome.values.begin();
  go(measures, [&](const auto&, const auto&, auto& value) { put(*at++, value); });
  return measures;
}

bool are_same(const Outcome& a, const Outcome& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) ||
           (std::isnan(x) && std::isnan(y));
  };
  return a.run == b.run && a.end == b.end && a.code == b.code && a.sha256 == b.sha256 &&
         std::ranges::equal(a.values, b.values, same);
}

}  // namespace mixloop
