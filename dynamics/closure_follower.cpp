// SPDX-License-Identifier: MIT
#include "dynamics/closure_follower.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "notation/functions/sincos.hpp"

namespace mixloop {
namespace {

constexpr double kClosed = 1e-9;  // of a correction, whose square is left: round-off
constexpr int kMostRepeats = 8;
constexpr double kNear = 0.02;      // rad, or of the size: what the anchor's rates foretell
constexpr double kFarthest = 0.25;  // in one step

}  // namespace

ClosureFollower::ClosureFollower(std::shared_ptr<const Scene> scene, const Routine& closures)
    : scene_(std::move(scene)), closures_(closures) {
  sizes_.n = static_cast<std::size_t>(scene_->n());
  sizes_.started = scene_->started.size();
  sizes_.start = static_cast<std::size_t>(scene_->start_size());
  sizes_.blocks = scene_->blocks.size();
  sizes_.corrections = static_cast<std::size_t>(scene_->corrections());
  sizes_.rates = static_cast<std::size_t>(scene_->started_rates());
  for (const auto& closure : scene_->closures) sizes_.rows += static_cast<std::size_t>(closure.rows());
  for (const auto& block : scene_->blocks)
    for (int j : block.unknowns) sizes_.rows += scene_->turns(j);
  for (const auto& block : scene_->blocks)
    for (int j : block.corrected()) scales_.push_back(scene_->turns(j) ? 1 : 1 / scene_->size);
  for (const auto& psi : scene_->independent) lengths_.push_back(psi.linear ? 1 / scene_->size : 1);
  anchor_.resize(sizes_.start + sizes_.started * (sizes_.n + 1) + sizes_.n + 1);
  watched_.resize(sizes_.started * (sizes_.n + 1) + sizes_.rows + sizes_.blocks);
  psi_.resize(sizes_.n);
  const std::size_t most = std::max<std::size_t>(2 * sizes_.n, watched_.size());
  input_.resize(2 * sizes_.n + sizes_.start);
  output_.resize(std::max(most, 3 * sizes_.n * sizes_.n + 16) + 3 * sizes_.n + sizes_.start +
                 sizes_.corrections + sizes_.rates);
}

void ClosureFollower::stand(std::span<const double> psi, double t, std::span<const double> at) noexcept {
  double* to = anchor_.data();
  for (std::size_t s = 0; s < sizes_.started; ++s) {
    *to++ = at[s];
    if (scene_->turns(scene_->started[s]))
      *to++ = mixloop_functions::cos(at[s]), *to++ = mixloop_functions::sin(at[s]);
  }
  to = std::fill_n(to, sizes_.started * (sizes_.n + 1), 0.0);
  to = std::copy_n(psi.begin(), sizes_.n, to);
  *to = t;
}

void ClosureFollower::read(const double* solution, const double* rates, std::span<const double> psid,
                           const Motion& motion) const noexcept {
  for (std::size_t s = 0; s < sizes_.started; ++s, rates += sizes_.n + 1) {
    motion.at[s] = *solution;
    solution += scene_->turns(scene_->started[s]) ? 3 : 1;
    double rate = rates[sizes_.n];
    for (std::size_t i = 0; i < sizes_.n; ++i) rate += rates[i] * psid[i];
    motion.rate[s] = rate;
  }
}

void ClosureFollower::look(std::span<const double> psid, const Motion& motion) const noexcept {
  read(anchor_.data(), anchor_.data() + sizes_.start, psid, motion);
}

Status ClosureFollower::look_ahead(std::span<const double> psi, std::span<const double> psid, double t,
                                   const Motion& motion) noexcept {
  predict(psi, t, 0);
  const std::size_t gives = watched_.size();
  const Status status = solve(closures_, {psi, {}, {}, t}, 0, gives);
  read(output_.data() + gives, output_.data(), psid, motion);
  if (status == Status::ok) return status;
  for (double& rate : motion.rate) rate = std::numeric_limits<double>::quiet_NaN();
  return Status::not_closed;
}

void ClosureFollower::set_parameters(std::span<const double> parameters) {
  std::vector<double> home;
  for (int j : scene_->started) home.push_back(scene_->coordinates[static_cast<std::size_t>(j)].home);
  stand(scene_->home, 0, home);
  // From the defaults in steps, each from the one before.
  const std::vector<double> defaults = scene_->default_parameters();
  constexpr int kSteps = 16;
  std::vector<double> between(parameters.begin(), parameters.end());
  const bool same = std::equal(defaults.begin(), defaults.end(), parameters.begin());
  for (int k = same ? kSteps : 0; k <= kSteps; ++k) {
    for (std::size_t i = 0; i < defaults.size(); ++i)
      between[i] = k < kSteps ? defaults[i] + (parameters[i] - defaults[i]) * k / kSteps : parameters[i];
    closures_.set_up(between);
    if (step(scene_->home, 0) != Status::ok) break;
  }
  closures_.set_up(parameters);
  moved_ = 0;
}

void ClosureFollower::put_back(std::span<const double> anchor) noexcept {
  std::copy(anchor.begin(), anchor.end(), anchor_.begin());
}

ClosureWatch ClosureFollower::watch() const {
  ClosureWatch watch;
  watch.moved = moved_;
  const double* row = watched_.data() + sizes_.started * (sizes_.n + 1);
  for (std::size_t i = 0; i < sizes_.rows; ++i)
    if (!(std::abs(row[i]) <= watch.residual)) watch.residual = std::abs(row[i]);
  watch.conditions = {row + sizes_.rows, sizes_.blocks};
  return watch;
}

double ClosureFollower::way_to(std::span<const double> psi, double t) const noexcept {
  const double* rates = anchor_.data() + sizes_.start;
  const double* from = rates + sizes_.started * (sizes_.n + 1);
  double way = 0;
  for (std::size_t i = 0; i < sizes_.n; ++i) way = std::max(way, std::abs(psi[i] - from[i]) * lengths_[i]);
  for (std::size_t s = 0; s < sizes_.started; ++s, rates += sizes_.n + 1) {
    double by = rates[sizes_.n] * (t - from[sizes_.n]);
    for (std::size_t i = 0; i < sizes_.n; ++i) by += rates[i] * (psi[i] - from[i]);
    way = std::max(way, std::abs(by) / (scene_->turns(scene_->started[s]) ? 1 : scene_->size));
  }
  return way;
}

// Turned as a correction turns (solve_by_newton): on the unit circle to second order.
double ClosureFollower::predict(std::span<const double> psi, double t, std::size_t from) noexcept {
  const double* start = anchor_.data();
  const double* rates = start + sizes_.start;
  const double* of = rates + sizes_.started * (sizes_.n + 1);
  double* to = input_.data() + from;
  double farthest = 0;
  for (int j : scene_->started) {
    double by = rates[sizes_.n] * (t - of[sizes_.n]);
    for (std::size_t i = 0; i < sizes_.n; ++i) by += rates[i] * (psi[i] - of[i]);
    rates += sizes_.n + 1;
    farthest = std::max(farthest, std::abs(by) / (scene_->turns(j) ? 1 : scene_->size));
    if (!scene_->turns(j)) {
      *to++ = *start++ + by;
      continue;
    }
    const double half = 0.5 * by, square = half * half, scale = 1 / (1 + square);
    const double c = (1 - square) * scale, s = by * scale;
    *to++ = start[0] + by * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7))));
    *to++ = start[1] * c - start[2] * s;
    *to++ = start[2] * c + start[1] * s;
    start += 3;
  }
  return farthest;
}

// With a start in input_ behind what the evaluator takes.
Status ClosureFollower::solve(Evaluator& evaluator, const Arguments& at, std::size_t takes,
                              std::size_t gives) noexcept {
  const std::size_t solution = sizes_.corrections > 0 ? sizes_.start + sizes_.corrections : 0;
  const std::size_t rates = &evaluator == &closures_ ? 0 : sizes_.rates;
  const std::span<double> outputs = std::span(output_).first(gives + solution + rates);
  for (int repeat = 0; repeat < kMostRepeats; ++repeat) {
    const Status status = evaluator.evaluate({at.psi, at.psid, input_, at.t}, outputs);
    if (status != Status::ok) return status;
    double largest = 0;
    for (std::size_t i = 0; i < sizes_.corrections; ++i)
      largest = std::max(largest, std::abs(outputs[gives + sizes_.start + i]) * scales_[i]);
    if (largest < kClosed) return Status::ok;
    std::copy_n(outputs.begin() + static_cast<std::ptrdiff_t>(gives), sizes_.start,
                input_.begin() + static_cast<std::ptrdiff_t>(takes));
  }
  return Status::not_closed;
}

Status ClosureFollower::step(std::span<const double> psi, double t) noexcept {
  predict(psi, t, 0);
  const std::size_t gives = watched_.size();
  const Status status = solve(closures_, {psi, {}, {}, t}, 0, gives);
  if (status != Status::ok) return Status::not_closed;
  std::copy_n(output_.begin(), gives, watched_.begin());
  move(output_.data() + gives, output_.data(), psi, t);
  return Status::ok;
}

// On the branch and the turn of the anchor.
void ClosureFollower::move(const double* solution, const double* rates, std::span<const double> psi,
                           double t) noexcept {
  double* to = std::copy_n(solution, sizes_.start, anchor_.data());
  to = std::copy_n(rates, sizes_.started * (sizes_.n + 1), to);
  to = std::copy_n(psi.begin(), sizes_.n, to);
  *to = t;
}

// In steps, of which each starts from the one before: solutions stay on their branch, and no singular pose is
// stepped over unseen.
Status ClosureFollower::accept(std::span<const double> psi, double t) noexcept {
  const double way = way_to(psi, t);
  if (!std::isfinite(way)) return Status::not_finite;
  const int steps = 1 + static_cast<int>(std::min(way / kFarthest * 4, 1e5));
  const double* from = anchor_.data() + sizes_.start + sizes_.started * (sizes_.n + 1);
  double condition = 1, nearest = 0;
  for (int left = steps; left >= 1; --left) {
    for (std::size_t i = 0; i < sizes_.n; ++i)
      psi_[i] = left > 1 ? from[i] + (psi[i] - from[i]) / left : psi[i];
    moved_ = way;
    const double now = left > 1 ? from[sizes_.n] + (t - from[sizes_.n]) / left : t;
    if (const Status status = step(psi_, now); status != Status::ok) return status;
    if (sizes_.blocks == 0) continue;
    const ClosureWatch here = watch();
    condition = here.conditions[here.worst()];
    const double share = condition * way / steps;
    nearest = std::max(nearest, std::isfinite(share) ? share : HUGE_VAL);
  }
  moved_ = nearest / condition;
  return Status::ok;
}

Status ClosureFollower::evaluate(Evaluator& evaluator, const Arguments& at, std::size_t takes,
                                 std::span<double> outputs, bool follows) noexcept {
  if (sizes_.started == 0) {
    const Status status = evaluator.evaluate(at, outputs);
    return status == Status::ok ? status : cause_of(status, at);
  }
  const auto failed = [&](Status status) {
    std::fill(outputs.begin(), outputs.end(), std::numeric_limits<double>::quiet_NaN());
    return status;
  };
  if (follows && !(way_to(at.psi, at.t) <= kNear))
    if (const Status status = accept(at.psi, at.t); status != Status::ok) return failed(status);
  std::copy_n(at.input.begin(), takes, input_.begin());
  predict(at.psi, at.t, takes);
  const Status status = solve(evaluator, at, takes, outputs.size());
  if (status == Status::not_closed) return failed(status);
  std::copy_n(output_.begin(), outputs.size(), outputs.begin());
  if (status != Status::ok) return cause_of(status, at);
  const double* solution = output_.data() + outputs.size();
  if (follows && sizes_.rates > 0) move(solution, solution + sizes_.start + sizes_.corrections, at.psi, at.t);
  return status;
}

Status ClosureFollower::cause_of(Status status, const Arguments& at) noexcept {
  predict(at.psi, at.t, 0);
  const bool closed = solve(closures_, {at.psi, {}, {}, at.t}, 0, watched_.size()) == Status::ok;
  return closed ? status : Status::not_closed;
}

}  // namespace mixloop
