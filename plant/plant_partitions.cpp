// SPDX-License-Identifier: MIT
// A plant that goes over to other independent coordinates where those in use come near a singular pose.
#include <cmath>

#include "plant/plant.hpp"

namespace mixloop {
namespace {

constexpr double kNearCondition = 4;  // 1 at best
constexpr double kNearTicks = 8;      // ways of a tick to a singular pose
constexpr double kBetter = 0.5;       // of the condition: they don't go to and fro

bool is_near(const ClosureWatch& watch) {
  const double condition = watch.conditions[watch.worst()];
  return condition > kNearCondition || condition * watch.moved * kNearTicks > 1;
}

}  // namespace

// Where none are better, those in use go on until they stop.
void Plant::follow_partitions() {
  const ClosureFollower& closures = ideal_.dynamics().closures();
  partitions_->look(closures, state_.motion.psi(), state_.motion.psid(), state_.loops);
  const ClosureWatch watch = closures.watch();
  if (!is_closed_ || watch.is_singular() || !is_near(watch)) return;
  if (const int best = best_partition(watch); best != state_.loops.partition) go_over_to(best);
}

int Plant::best_partition(const ClosureWatch& watch) {
  int best = state_.loops.partition;
  double least = kBetter * watch.conditions[watch.worst()];
  for (int other = 0; other < partitions_->size(); ++other) {
    if (other == state_.loops.partition) continue;
    const double condition = partitions_->stand(other, state_.loops, time());
    if (condition < least) best = other, least = condition;
  }
  return best;
}

void Plant::go_over_to(int partition) {
  auto& x = state_.motion.x;
  const std::size_t n = state_.motion.n();
  partitions_->independent(partition, state_.loops, {x.data(), n}, {x.data() + n, n});
  partitions_->exchange(ideal_.dynamics(), partition);
  state_.loops.partition = stage_.partition = partition;
  ++state_.switches;
}

Plant::Declared Plant::declared_at(double t, const Vector& x) {
  const std::size_t n = state_.motion.n();
  const std::span<const double> z(x.data(), n), zd(x.data() + n, n);
  if (!is_switched()) return {z, zd};
  partitions_->look_ahead(ideal_.dynamics().closures(), z, zd, t, stage_);
  return {partitions_->psi(stage_), partitions_->psid(stage_)};
}

}  // namespace mixloop
