// SPDX-License-Identifier: MIT
// The yardstick must be right before it may be fast: against the closed form in 113 bits.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bench/hand_tuned.hpp"
#include "bench/hand_tuned_simd.hpp"
#include "bench/hand_tuned_sincos.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/wide.hpp"

namespace mixloop::hand_tuned {
namespace {

using oracle::Wide;
using Robot = oracle::MixedLoopRobot<Wide>;
using WideVector = Robot::Vector3;

constexpr auto kSincos = [](double x, double* s, double* c) {
  *s = std::sin(x);
  *c = std::cos(x);
};

struct State {
  double psi[3], psid[3], tau[3];

  explicit State(std::mt19937_64& random) {
    std::uniform_real_distribution<double> angle(-30, 30), rate(-40, 40), torque(-5, 5);
    for (int k = 0; k < 3; ++k) psi[k] = angle(random), psid[k] = rate(random), tau[k] = torque(random);
  }
};

WideVector wide(const double* x) { return {Wide(x[0]), Wide(x[1]), Wide(x[2])}; }

double relative(const double* actual, const WideVector& expected) {
  return static_cast<double>((wide(actual) - expected).norm() / expected.norm());
}

// 1e-12: about a hundred times what angles of 30 rad, rounded to a double, and M's condition leave.
constexpr double kTolerance = 1e-12;

TEST(HandTuned, EveryVariantAgreesWithTheClosedForm) {
  std::mt19937_64 random(11);
  for (const double payload : {0.0, 1.5, 5.0}) {
    const Robot robot(oracle::paper_numbers<Wide>(Wide(payload)));
    const Lumped n = lump(payload);
    for (int sample = 0; sample < 300; ++sample) {
      const State state(random);
      const WideVector psi = wide(state.psi), psid = wide(state.psid), tau = wide(state.tau);
      const WideVector expected = robot.forward_dynamics(psi, psid, tau);
      double psidd[3];
      const auto check = [&](const char* variant) {
        EXPECT_LT(relative(psidd, expected), kTolerance) << variant << ", sample " << sample;
      };
      forward_dynamics(n, three_pairs(state.psi, kSincos), state.psid, state.tau, psidd);
      check("three pairs");
      forward_dynamics(n, two_pairs(state.psi, kSincos), state.psid, state.tau, psidd);
      check("two pairs");
      paired_forward_dynamics(n, state.psi, state.psid, state.tau, psidd);
      check("vectors inside");

      double tau_back[3], feed_forward[3], M[6];
      const auto angles = three_pairs(state.psi, kSincos);
      inverse_dynamics(n, angles, state.psid, psidd, tau_back);
      EXPECT_LT(relative(tau_back, robot.inverse_dynamics(psi, psid, wide(psidd))), kTolerance);
      mass_times(n, angles, state.tau, feed_forward);
      const auto mass = robot.mass_matrix(psi);
      EXPECT_LT(relative(feed_forward, mass * tau), kTolerance);
      forward_dynamics_and_mass_times(n, angles, state.psid, state.tau, state.psid, psidd, feed_forward);
      check("together with M a");
      EXPECT_LT(relative(feed_forward, mass * psid), kTolerance);
      for (const bool paired : {false, true}) {
        if (paired)
          paired_mass_matrix(n, state.psi, M);
        else
          mass_matrix(n, angles, M);
        int k = 0;
        for (int i = 0; i < 3; ++i)
          for (int j = i; j < 3; ++j) EXPECT_NEAR(M[k++], static_cast<double>(mass(i, j)), 1e-16);
      }
    }
  }
}

TEST(HandTuned, LanesAgreeWithTheClosedForm) {
  std::mt19937_64 random(12);
  const Robot robot(oracle::paper_numbers<Wide>());
  const Lumped n = lump(5);
  for (int sample = 0; sample < 50; ++sample) {
    Lanes<8> psi[3], psid[3], tau[3], psidd[3];
    std::vector<State> states;
    for (int lane = 0; lane < 8; ++lane) {
      const State& state = states.emplace_back(random);
      for (int k = 0; k < 3; ++k)
        psi[k][lane] = state.psi[k], psid[k][lane] = state.psid[k], tau[k][lane] = state.tau[k];
    }
    forward_dynamics(n, three_pairs(psi, lane_sincos<8>), psid, tau, psidd);
    for (int lane = 0; lane < 8; ++lane) {
      const State& state = states[lane];
      const double one[3] = {psidd[0][lane], psidd[1][lane], psidd[2][lane]};
      EXPECT_LT(relative(one, robot.forward_dynamics(wide(state.psi), wide(state.psid), wide(state.tau))),
                kTolerance);
    }
  }
}

/// Error in units of the last place of the exact value.
double ulps(double actual, const Wide& exact) {
  const double rounded = static_cast<double>(exact);
  const double unit = std::nextafter(std::abs(rounded), INFINITY) - std::abs(rounded);
  return std::abs(static_cast<double>(Wide(Wide(actual) - exact))) / unit;
}

TEST(LaneSincos, StaysWithinItsStatedError) {
  std::mt19937_64 random(13);
  for (const auto& [range, bound] : {std::pair{1.0, 1.6}, {100.0, 1.6}, {1e6, 2.5}}) {
    double worst = 0;
    for (int sample = 0; sample < 10000; ++sample) {
      std::uniform_real_distribution<double> angle(-range, range);
      const Lanes<2> x{angle(random), angle(random)};
      Lanes<2> s, c;
      lane_sincos<2>(x, &s, &c);
      for (int lane = 0; lane < 2; ++lane) {
        worst = std::max(worst, ulps(s[lane], sin(Wide(x[lane]))));
        worst = std::max(worst, ulps(c[lane], cos(Wide(x[lane]))));
        double sine, cosine;
        paired_sincos(x[lane], &sine, &cosine);
        EXPECT_EQ(sine, s[lane]) << x[lane];
        EXPECT_EQ(cosine, c[lane]) << x[lane];
      }
    }
    EXPECT_LT(worst, bound) << "|x| <= " << range;
  }
}

/// A scalar that counts: what the evaluation takes beside its sines and cosines.
struct Counted {
  double value = 0;
  static inline int operations = 0;

  Counted() = default;
  Counted(double x) : value(x) {}  // NOLINT(google-explicit-constructor)
  friend Counted operator+(Counted a, Counted b) { return ++operations, Counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return ++operations, Counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return ++operations, Counted(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return ++operations, Counted(a.value / b.value); }
  Counted operator-() const { return ++operations, Counted(-value); }
};

constexpr auto kCountedSincos = [](Counted x, Counted* s, Counted* c) {
  *s = std::sin(x.value);
  *c = std::cos(x.value);
};

int count(auto&& evaluation) {
  Counted::operations = 0;
  evaluation();
  return Counted::operations;
}

// Products of constants (2 k1) are doubles here and not counted. M and M a leave the four products that only
// the bias takes to the compiler to drop; the full M has one sum that makes a lane of a constant.
TEST(HandTuned, TakesTheStatedOperations) {
  const Lumped n = lump(5);
  Counted x[3] = {1, 2, 3}, out[6];
  const int pairs = count([&] { three_pairs(x, kCountedSincos); });
  const auto angles = three_pairs(x, kCountedSincos);
  EXPECT_EQ(pairs, 9);
  EXPECT_EQ(pairs + count([&] { forward_dynamics(n, angles, x, x, out); }), 125);
  EXPECT_EQ(count([&] { two_pairs(x, kCountedSincos); }), 27);
  EXPECT_EQ(pairs + count([&] { mass_matrix(n, angles, out); }) - 5, 51);
  EXPECT_EQ(pairs + count([&] { mass_times(n, angles, x, out); }) - 4, 59);
  Counted force[3];
  EXPECT_EQ(pairs + count([&] { forward_dynamics_and_mass_times(n, angles, x, x, x, out, force); }), 141);
}

}  // namespace
}  // namespace mixloop::hand_tuned
