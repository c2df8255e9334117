// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "plant/plant.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

/// Where a plant under steps of torque ends after 300 ticks: psi, psid and work.
struct Stepped {
  Vector end = Vector(7);
  double most = 0;  ///< torque over its limit, the largest; infinite where the state isn't finite
};

Stepped stepped(const SharedScene& scene, const std::vector<double>& limit, std::int64_t seed, int substeps) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  Plant plant({equations_of(scene, Evaluation::machine_code, {Purpose::forward_dynamics}),
               scene->default_parameters()},
              {.substeps = substeps, .torque_limit = limit}, 1000, scene->home);
  std::vector<double> tau(3);
  Stepped result;
  const auto look = [&] {
    for (std::size_t i = 0; i < 3; ++i)
      result.most = std::max(result.most, std::abs(plant.applied()[i]) / limit[i]);
  };
  for (int k = 0; k < 300; ++k) {
    // Now and then a step to anything up to the largest doubles.
    if (k % 25 == 0)
      for (double& x : tau) x = (random() % 2 == 0 ? 1 : -1) * log_uniform(random, 1, 1e307);
    plant.command(tau);
    look();
    plant.advance();
    look();
  }
  result.end << map_of(plant.psi()), map_of(plant.psid()), plant.work();
  if (!result.end.allFinite()) result.most = HUGE_VAL;
  return result;
}

// A torque step at saturation: whatever is asked for, the motors give their limit and no more, and the state
// follows. Against a converged run (64 steps a tick): of a method of order p the error is (1 - 2^-p)^-1 of
// what halving the step changes; half as much again for the higher orders.
TEST(Saturation, KeepsTheTorqueWithinItsLimitAndTheStateExact) {
  const std::int64_t seeds = length(3, 300);
  const SharedScene scene = papers_robot();
  Figure excess("saturation_torque", "of the limit", 1, seeds * 3);
  Figure error("saturation_error", "of what halving the step changes", 1.6, seeds);
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    const std::vector<double> limit = {2, 5, 3};
    const Stepped one = stepped(scene, limit, seed, 1), two = stepped(scene, limit, seed, 2),
                  many = stepped(scene, limit, seed, 64);
    for (const Stepped* run : {&one, &two, &many})
      excess.look(run->most, [&] { return fmt::format("seed {}", seed); });
    // Where both differences are rounding, there is nothing to compare.
    const double off = (one.end - many.end).norm(), rounding = 1e4 * kEps * many.end.norm();
    error.look(off / ((one.end - two.end).norm() + rounding),
               [&] { return fmt::format("seed {}: {:.3g} with one step a tick", seed, off); });
  }
}

}  // namespace
}  // namespace mixloop::stress
