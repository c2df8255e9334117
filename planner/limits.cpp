// SPDX-License-Identifier: MIT
#include "planner/limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mixloop {
namespace {

void require(const std::vector<double>& limit, std::size_t n_u, const char* what) {
  if (limit.empty()) return;
  if (limit.size() != n_u)
    throw InputError("wrong_size", {},
                     fmt::format("the {} limit has {} values; expected one for each of the {} motors", what,
                                 limit.size(), n_u));
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
}

void LimitCheck::look(std::int64_t step, const Reference& reference, double t) {
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

void LimitCheck::compare(std::int64_t step, std::size_t motor, double value, double limit, bool torque) {
  constexpr double kSlack = 1e-9;  // a move worked out to run at its limit is off by rounding
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
