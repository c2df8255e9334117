// SPDX-License-Identifier: MIT
// The shipped mechanisms with free coordinates, against equations of motion that textbooks have, integrated
// on their own in short steps with the torque held over each tick.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "loop/review.hpp"
#include "loop/simulate.hpp"
#include "loop/truth.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using State = std::array<long double, 4>;  // psi, psid

/// A u + B v = p, B u + D v = q.
std::array<long double, 2> solved(long double A, long double B, long double D, long double p, long double q) {
  const long double det = A * D - B * B;
  return {(p * D - q * B) / det, (A * q - B * p) / det};
}

/// (M + m) x'' - m l cos phi'' + m l sin phi'^2 + b x' = F, (I + m l^2) phi'' - m l cos x'' = m g l sin,
/// phi's way against x's.
std::array<long double, 2> cart_pole(const State& s, long double F) {
  const long double M = 0.5L, m = 0.2L, b = 0.1L, l = 0.3L, I = 0.006L, g = 9.8L;
  const long double sine = std::sin(s[1]), cosine = std::cos(s[1]);
  return solved(M + m, -m * l * cosine, I + m * l * l, F - b * s[2] - m * l * sine * s[3] * s[3],
                m * g * l * sine);
}

/// T = 1/2 (J0 + J2 sin^2) arm'^2 + 1/2 J2 pend'^2 + m L1 l2 cos arm' pend', V = m g l2 cos.
std::array<long double, 2> furuta(const State& s, long double tau) {
  const long double m1 = 0.3L, m2 = 0.075L, l1 = 0.15L, l2 = 0.148L, L1 = 0.278L, g = 9.81L;
  const long double J0 = 0.0248L + m1 * l1 * l1 + m2 * L1 * L1, J2 = 0.00386L + m2 * l2 * l2,
                    K = m2 * L1 * l2;
  const long double sine = std::sin(s[1]), cosine = std::cos(s[1]), twice = std::sin(2 * s[1]);
  return solved(J0 + J2 * sine * sine, K * cosine, J2,
                tau - 1e-4L * s[2] - J2 * twice * s[2] * s[3] + K * sine * s[3] * s[3],
                J2 / 2 * twice * s[2] * s[2] + m2 * g * l2 * sine - 2.8e-4L * s[3]);
}

using Accelerations = std::array<long double, 2> (*)(const State&, long double);

/// One tick by 20 steps of Runge and Kutta's: what they miss is below a double's last place.
State ticked(Accelerations of, State s, long double tau, long double tick) {
  const int steps = 20;
  const long double h = tick / steps;
  const auto rate = [&](const State& x) {
    const auto a = of(x, tau);
    return State{x[2], x[3], a[0], a[1]};
  };
  const auto moved = [](const State& x, const State& by, long double times) {
    State sum = x;
    for (std::size_t i = 0; i < 4; ++i) sum[i] += by[i] * times;
    return sum;
  };
  for (int k = 0; k < steps; ++k) {
    const State a = rate(s), b = rate(moved(s, a, h / 2)), c = rate(moved(s, b, h / 2)),
                d = rate(moved(s, c, h));
    for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return s;
}

/// Where the law leaves it after the experiment's ticks.
State held_upright(Accelerations of, const Experiment& experiment, std::int64_t ticks) {
  State s{};
  for (std::size_t i = 0; i < 2; ++i) s[i] = static_cast<long double>(experiment.plant.initial_psi[i]);
  for (std::int64_t k = 0; k < ticks; ++k) {
    long double tau = 0;
    for (std::size_t j = 0; j < 4; ++j)
      tau -= static_cast<long double>(experiment.controller.gain(0, static_cast<Eigen::Index>(j))) * s[j];
    s = ticked(of, s, tau, 1 / static_cast<long double>(experiment.rate_hz));
  }
  return s;
}

class HeldUpright : public testing::TestWithParam<std::pair<const char*, Accelerations>> {};

// 1e-11: what rounding makes of some thousand ticks of a loop that forgets.
TEST_P(HeldUpright, EndsWhereTheTextbooksEquationsEnd) {
  const auto& [name, of] = GetParam();
  const Experiment experiment = shipped_experiment(name);
  const Measures measures = simulated(experiment);
  ASSERT_TRUE(measures.final_psi);
  const State expected = held_upright(of, experiment, measures.ticks);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR((*measures.final_psi)[static_cast<Eigen::Index>(i)], static_cast<double>(expected[i]), 1e-11)
        << i;
}

// Without the law it falls: the motion is no small one, and the equations are whole.
TEST_P(HeldUpright, FallsAsTheTextbooksEquationsDo) {
  const auto& [name, of] = GetParam();
  Experiment experiment = shipped_experiment(name);
  experiment.controller.gain.setZero();
  experiment.duration = 2;
  const Measures measures = simulated(experiment);
  const State expected = held_upright(of, experiment, measures.ticks);
  EXPECT_GT(std::abs(expected[1]), 2) << "it has fallen";
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR((*measures.final_psi)[static_cast<Eigen::Index>(i)], static_cast<double>(expected[i]), 1e-8)
        << i;
}

TEST_P(HeldUpright, IsStableAndWarnsOfNothing) {
  const Experiment experiment = shipped_experiment(GetParam().first);
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  EXPECT_TRUE(review(experiment, plan, run.recorder()).empty());
}

INSTANTIATE_TEST_SUITE_P(Shipped, HeldUpright,
                         testing::Values(std::pair("cart_pole", &cart_pole),
                                         std::pair("furuta_pendulum", &furuta)),
                         [](const auto& tested) { return std::string(tested.param.first); });

// (I + m l^2) phi'' = m g l sin: the pole alone moves, and TRUTH says so.
TEST(LockedCart, IsToldWithThePolesOwnAcceleration) {
  Experiment experiment =
      load_experiment(std::filesystem::path(MIXLOOP_SOURCE "/experiments/cart_pole.yaml"),
                      {{"real_time", "{safe_state: brake}"}, {"duration", "0.2 s"}, {"expect", "{}"}});
  experiment.evaluation = Evaluation::interpreter;
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  ASSERT_TRUE(run.begin());
  run.make_safe("a test");
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(run.real_time_tick({}, [](std::int64_t) { return true; }));
  TruthReader reader(experiment, run.recorder());
  for (std::int64_t k = 0; k < 200; ++k) {
    const Truth& truth = reader.at(k);
    EXPECT_EQ(truth.psidd[0], 0);
    EXPECT_NEAR(truth.psidd[1], 0.2 * 9.8 * 0.3 * std::sin(run.recorder().psi(k)[1]) / 0.024, 1e-12);
  }
  EXPECT_EQ(run.plant().psi()[0], 0);
  EXPECT_GT(run.plant().psi()[1], 0.25) << "it falls";
}

}  // namespace
}  // namespace mixloop
