// SPDX-License-Identifier: MIT
// A mass of 1 kg that a force moves, x'' = u, and whole-number answers.
#include "stability/sampled_loop.hpp"

#include <gtest/gtest.h>

#include "stability/limits.hpp"

namespace mixloop {
namespace {

LinearLoop mass(double kp, double kv) {
  LinearLoop loop{Matrix{{0, 1}, {0, 0}}, Matrix{{0}, {1}}, {Matrix{{-kp, -kv}}, Matrix::Zero(1, 2)}};
  return loop;
}

// Without delay: x + 2 x' + 2 u, x' + 2 u in a tick of 2 s.
TEST(SampledLoop, HoldsTheForceOverATick) {
  const LinearLoop loop = mass(3, 5);
  const Matrix next = sampled_transition(loop, loop.feedback.gain(), {2, 0});
  EXPECT_TRUE(next.isApprox(Matrix{{1 - 6, 2 - 10, 0}, {-6, 1 - 10, 0}, {-3, -5, 0}}, 1e-14)) << next;
}

// Half of the tick under the last command: G_1 = (3/2, 1) for the second of the old force, that has 1 s left
// to coast, and G_0 = (1/2, 1).
TEST(SampledLoop, SplitsATickAtTheDelay) {
  const LinearLoop loop = mass(3, 5);
  const Matrix next = sampled_transition(loop, loop.feedback.gain(), {2, 1});
  EXPECT_TRUE(next.isApprox(Matrix{{1 - 1.5, 2 - 2.5, 1.5}, {-3, 1 - 5, 1}, {-3, -5, 0}}, 1e-14)) << next;
}

// A delay of one tick is a delay that takes all of the tick.
TEST(SampledLoop, PassesAWholeTickWithoutAJump) {
  const LinearLoop loop = mass(3, 5);
  const Matrix gain = loop.feedback.gain();
  const double before = sampled_radius(loop, gain, {0.1, 0.1 - 1e-7}),
               at = sampled_radius(loop, gain, {0.1, 0.1}),
               after = sampled_radius(loop, gain, {0.1, 0.1 + 1e-7});
  EXPECT_NEAR(before, at, 1e-5);
  EXPECT_NEAR(after, at, 1e-5);
}

// x' sampled under u = -kv x' alone has the multiplier 1 - kv T: stable to kv T = 2.
TEST(Limits, FindTheLongestTickOfAVelocityLoop) {
  EXPECT_NEAR(limits_of(mass(1e-6, 4), {0.1, 0}).longest_tick.value(), 0.5, 1e-5);
}

// |1 + z + z^2/2 + z^3/6 + z^4/24| = 1 at z = -2.785293563405282 (Hairer & Wanner, IV.2).
TEST(Limits, FindTheRealLimitOfRk4) {
  EXPECT_NEAR(limits_of(mass(1e-9, 4), {0.1, 0}).longest_rk4_step.value() * 4, 2.785293563405282, 1e-6);
}

TEST(Limits, GoBothWaysFromAStableGain) {
  const Limits limits = limits_of(mass(1e-6, 4), {0.1, 0});
  EXPECT_NEAR(limits.most_gain.value(), 5, 1e-4);  // kv T = 2
  EXPECT_FALSE(limits.least_gain.has_value()) << "any gain holds a mass in the end";
  EXPECT_LT(limits.radius, 1);
}

}  // namespace
}  // namespace mixloop
