// SPDX-License-Identifier: MIT
#include "planner/plan.hpp"

#include <algorithm>
#include <limits>

#include "planner/plan_maker.hpp"

namespace mixloop {

Plan::Plan(const Model<double>& model, const Path& path, const Settings& settings)
    : n_u_(model.n_u()), stages_(settings.stages_per_tick * static_cast<int>(settings.within.size())) {
  PlanMaker(model, path, settings).make(*this);
}

Plan Plan::without_path(const PsiMotion& motors, std::int64_t ticks) {
  Plan plan;
  plan.has_path_ = false;
  plan.n_u_ = static_cast<int>(motors.psi.size());
  plan.ticks_ = ticks;
  for (const Vector* values : {&motors.psi, &motors.psid, &motors.psidd})
    plan.table_.insert(plan.table_.end(), values->begin(), values->end());
  plan.table_.resize(reference_size(plan.n_u_), std::numeric_limits<double>::quiet_NaN());
  return plan;
}

std::span<const double> Plan::row_of(std::int64_t index) const {
  if (!has_path_) return table_;
  const std::int64_t start = start_tick_ * stages_, end = ticks_ * stages_, rows = start + lap_rows_;
  std::int64_t row = std::max<std::int64_t>(index, 0);
  if (row >= end)
    row = row > end ? rows + 1 : rows;
  else if (row >= rows)
    row = start + (row - start) % lap_rows_;
  const std::size_t size = reference_size(n_u_);
  return {table_.data() + static_cast<std::size_t>(row) * size, size};
}

Reference Plan::at_stage(std::int64_t k, int j) const {
  // Far past the end, k * stages_ would overflow.
  const std::int64_t tick = std::clamp<std::int64_t>(k, -1, ticks_ + 1);
  return reference_in(row_of(tick * stages_ + (tick == k ? j : 0)), n_u_);
}

}  // namespace mixloop
