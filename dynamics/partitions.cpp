// SPDX-License-Identifier: MIT
#include "dynamics/partitions.hpp"

#include <algorithm>
#include <cmath>

#include "notation/errors.hpp"

namespace mixloop {
namespace {

Equations::Workspace workspace_of(const Partition& partition, Evaluation how,
                                  std::initializer_list<Purpose> purposes, Equations::Options options,
                                  std::span<const double> parameters) {
  auto equations = equations_of(partition.scene, how, purposes, options);
  if (equations->evaluation() == Evaluation::reference)
    throw InputError(
        "too_large", {partition.scene->name},
        "coordinates are switched by programs, and the procedure itself serves here: it was asked "
        "for, or a program takes more operations than one may; expected another evaluation, a "
        "smaller mechanism, or near_singular: stop");
  Equations::Workspace workspace(std::move(equations), parameters);
  workspace.hold_anchor();
  return workspace;
}

}  // namespace

Partitions::Partitions(List partitions, Evaluation how, std::initializer_list<Purpose> purposes,
                       Equations::Options options, std::span<const double> parameters)
    : list_(std::move(partitions)), n_(declared().independent.size()) {
  const std::vector<int>& solved = declared().started;
  const auto place_of = [&](int coordinate) {
    return static_cast<std::size_t>(std::ranges::find(solved, coordinate) - solved.begin());
  };
  for (const Partition& partition : *list_) {
    Places places;
    for (std::size_t i = 0; i < n_; ++i)
      places.independent.push_back(static_cast<int>(i) == partition.swapped ? place_of(partition.freed)
                                                                            : solved.size() + i);
    for (int j : partition.scene->started)
      places.started.push_back(
          j == partition.solved ? solved.size() + static_cast<std::size_t>(partition.swapped) : place_of(j));
    places_.push_back(std::move(places));
    dynamics_.push_back(workspace_of(partition, how, purposes, options, parameters));
  }
  at_ = rate_ = Vector::Zero(static_cast<Eigen::Index>(solved.size()));
  z_ = zd_ = Vector::Zero(static_cast<Eigen::Index>(n_));
}

void Partitions::set_parameters(std::span<const double> parameters, double friction) noexcept {
  for (auto& dynamics : dynamics_) dynamics.set_parameters(parameters, friction);
}

void Partitions::exchange(Equations::Workspace& in_use, int partition) noexcept {
  for (const int other : {in_use_, partition})
    if (other > 0) std::swap(in_use, dynamics_[static_cast<std::size_t>(other)]);
  in_use_ = partition;
}

std::size_t Partitions::longest_anchor() const {
  std::size_t longest = 0;
  for (const auto& dynamics : dynamics_) longest = std::max(longest, dynamics.closures().anchor().size());
  return longest;
}

LoopMotion Partitions::motion() const {
  const Vector none = Vector::Zero(at_.size() + z_.size());
  return {.at = none, .rate = none};
}

void Partitions::independent(int partition, const LoopMotion& motion, std::span<double> z,
                             std::span<double> zd) const noexcept {
  const auto& places = places_[static_cast<std::size_t>(partition)].independent;
  for (std::size_t i = 0; i < n_; ++i) {
    z[i] = motion.at[static_cast<Eigen::Index>(places[i])];
    zd[i] = motion.rate[static_cast<Eigen::Index>(places[i])];
  }
}

void Partitions::gather(int partition, std::span<const double> z, std::span<const double> zd,
                        LoopMotion& motion) const {
  const auto& [independent, started] = places_[static_cast<std::size_t>(partition)];
  const auto put = [&](std::size_t place, double at, double rate) {
    motion.at[static_cast<Eigen::Index>(place)] = at;
    motion.rate[static_cast<Eigen::Index>(place)] = rate;
  };
  for (std::size_t i = 0; i < n_; ++i) put(independent[i], z[i], zd[i]);
  for (std::size_t s = 0; s < started.size(); ++s)
    put(started[s], at_[static_cast<Eigen::Index>(s)], rate_[static_cast<Eigen::Index>(s)]);
}

void Partitions::look(const ClosureFollower& closures, std::span<const double> z, std::span<const double> zd,
                      LoopMotion& motion) noexcept {
  closures.look(zd, hand());
  gather(motion.partition, z, zd, motion);
}

void Partitions::look_ahead(ClosureFollower& closures, std::span<const double> z, std::span<const double> zd,
                            double t, LoopMotion& motion) noexcept {
  closures.look_ahead(z, zd, t, hand());
  gather(motion.partition, z, zd, motion);
}

double Partitions::stand(int partition, const LoopMotion& motion, double t) noexcept {
  const auto& started = places_[static_cast<std::size_t>(partition)].started;
  independent(partition, motion, span_of(z_), span_of(zd_));
  for (std::size_t s = 0; s < started.size(); ++s)
    at_[static_cast<Eigen::Index>(s)] = motion.at[static_cast<Eigen::Index>(started[s])];
  ClosureFollower& closures = dynamics(partition).closures();
  closures.stand(span_of(z_), t, span_of(at_));
  if (closures.accept(span_of(z_), t) != Status::ok) return HUGE_VAL;
  const ClosureWatch watch = closures.watch();
  const double condition = watch.conditions[watch.worst()];
  return std::isfinite(condition) ? condition : HUGE_VAL;
}

Status Partitions::evaluate(Purpose purpose, const LoopMotion& motion, std::span<const double> input,
                            double t, std::span<double> outputs) noexcept {
  stand(motion.partition, motion, t);
  return dynamics(motion.partition).evaluate(purpose, {span_of(z_), span_of(zd_), input, t}, outputs);
}

}  // namespace mixloop
