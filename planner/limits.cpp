// SPDX-License-Identifier: MIT
#include "planner/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

constexpr double kSlack = 1e-9;  // a move worked out to run at its limit is off by rounding

template <class Limit>
void require_each(const std::vector<Limit>& limit, std::size_t n_u, const char* what) {
  if (!limit.empty() && limit.size() != n_u)
    throw InputError("wrong_size", {},
                     fmt::format("the {} limit has {} values; expected one for each of the {} motors", what,
                                 limit.size(), n_u));
}

void require(const std::vector<double>& limit, std::size_t n_u, const char* what) {
  require_each(limit, n_u, what);
  for (const double value : limit)
    if (!(value > 0))
      throw InputError("out_of_range", {},
                       fmt::format("a {} limit of {}; expected more than 0", what, value));
}

}  // namespace

LimitCheck::LimitCheck(const Model<double>& model, const PlanLimits& limits)
    : model_(model), limits_(limits), ws_(model) {
  const std::size_t n_u = model.scene->motors().size();
  require(limits.velocity, n_u, "velocity");
  require(limits.torque, n_u, "torque");
  require_each(limits.position, n_u, "position");
  for (const auto& [least, most] : limits.position)
    if (!(least < most))
      throw InputError(
          "out_of_range", {},
          fmt::format("a position limit from {:g} to {:g}; expected the lower one first", least, most));
}

void LimitCheck::look(std::int64_t step, const Reference& reference, double t) {
  for (std::size_t i = 0; i < limits_.position.size(); ++i)
    compare_position(step, i, reference.psi[static_cast<Eigen::Index>(i)]);
  if (limits_.velocity.empty() && limits_.torque.empty()) return;
  for (std::size_t i = 0; i < limits_.velocity.size(); ++i) {
    const auto motor = static_cast<Eigen::Index>(i);
    compare(step, i, reference.psid[motor], limits_.velocity[i], false);
    if (step == last_step_ + 1)
      compare(step, i, (reference.psi[motor] - last_psi_[motor]) / (t - last_t_), limits_.velocity[i], false);
  }
  last_step_ = step;
  last_t_ = t;
  last_psi_ = reference.psi;
  if (limits_.torque.empty()) return;
  const PsiMotion all = whole_motion(*model_.scene, reference);
  const auto& tau =
      inverse_dynamics<double>(model_, span_of(all.psi), span_of(all.psid), span_of(all.psidd), t, ws_);
  for (std::size_t i = 0; i < limits_.torque.size(); ++i)
    compare(step, i, tau[static_cast<Eigen::Index>(i)], limits_.torque[i], true);
}

void LimitCheck::compare_position(std::int64_t step, std::size_t motor, double value) {
  const auto [least, most] = limits_.position[motor];
  const double ratio = 1 + std::max(least - value, value - most) / (most - least);
  if (ratio <= (worst_ ? worst_->ratio : 1 + kSlack)) return;
  const Scene::Independent& limited = model_.scene->motors()[motor];
  worst_ =
      Excess{step, ratio,
             fmt::format("the motor {} would stand at {:.6g} {unit}; its limits are {:.6g} to {:.6g} {unit}",
                         limited.name, value, least, most, fmt::arg("unit", limited.linear ? "m" : "rad"))};
}

void LimitCheck::compare(std::int64_t step, std::size_t motor, double value, double limit, bool torque) {
  const double ratio = std::abs(value) / limit;
  if (ratio <= (worst_ ? worst_->ratio : 1 + kSlack)) return;
  const Scene::Independent& limited = model_.scene->motors()[motor];
  const char* unit = torque ? (limited.linear ? "N" : "N m") : (limited.linear ? "m/s" : "rad/s");
  worst_ =
      Excess{step, ratio,
             fmt::format("the motor {} would {} {:.6g} {}, {:.4g} times its limit of {:.6g} {}", limited.name,
                         torque ? "need" : "move at", std::abs(value), unit, ratio, limit, unit)};
}

}  // namespace mixloop
