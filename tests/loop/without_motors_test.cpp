// SPDX-License-Identifier: MIT
// Mechanisms that no motor drives, moved by constraints that depend on time, against textbooks' equations.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/bad_input.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

Experiment shipped(const std::string& name, const std::vector<Override>& overrides) {
  Experiment experiment =
      load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / (name + ".yaml"), overrides);
  experiment.evaluation = Evaluation::interpreter;
  return experiment;
}

/// theta'' = (g - a w^2 cos(w t)) / l sin(theta), by short steps of Runge and Kutta's.
long double shaken(long double theta, long double frequency, long double duration) {
  const long double a = 5e-3L, l = 0.5L, g = 9.81L, w = 2 * std::numbers::pi_v<long double> * frequency;
  using Swing = std::array<long double, 2>;
  const auto rate = [&](const Swing& s, long double t) {
    return Swing{s[1], (g - a * w * w * std::cos(w * t)) / l * std::sin(s[0])};
  };
  const auto moved = [](const Swing& s, const Swing& by, long double h) {
    return Swing{s[0] + h * by[0], s[1] + h * by[1]};
  };
  Swing s{theta, 0};
  const long double h = 1e-5L;
  const auto steps = std::llround(duration / h);
  for (long long k = 0; k < steps; ++k) {
    const long double t = static_cast<long double>(k) * h;
    const Swing p = rate(s, t), q = rate(moved(s, p, h / 2), t + h / 2),
                r = rate(moved(s, q, h / 2), t + h / 2), u = rate(moved(s, r, h), t + h);
    for (std::size_t i = 0; i < 2; ++i) s[i] += h / 6 * (p[i] + 2 * q[i] + 2 * r[i] + u[i]);
  }
  return s[0];
}

TEST(KapitzasPendulum, MovesAsTheTextbooksEquation) {
  const Measures measures = simulated(shipped("kapitza_upright", {}));
  ASSERT_TRUE(measures.final_psi);
  EXPECT_NEAR((*measures.final_psi)[0], static_cast<double>(shaken(0.1L, 120, 10)), 1e-9);
  EXPECT_EQ(measures.max_torque.size(), 0);
}

// a^2 w^2 = 2 g l: 99.7 Hz, up to some hundredths, for a is no smaller than l / 100.
TEST(KapitzasPendulum, StaysUpFromTheTextbooksThresholdOn) {
  const double threshold = std::sqrt(2 * 9.81 * 0.5) / 5e-3 / (2 * std::numbers::pi);
  const auto farthest = [&](double part) {
    const Experiment experiment = shipped(
        "kapitza_upright", {{"parameters", "{frequency: " + std::to_string(part * threshold) + " Hz}"},
                            {"plant.initial", "[0.001]"},
                            {"expect", "{}"}});
    const Plan plan = make_plan(experiment);
    RecordedPlant run(experiment, plan);
    simulate(run, [](std::int64_t) { return true; });
    double most = 0;
    for (std::int64_t k = 0; k < run.recorder().ticks_recorded(); ++k)
      most = std::max(most, std::abs(run.recorder().psi(k)[0]));
    return most;
  };
  EXPECT_LT(farthest(1.05), 0.01);
  EXPECT_GT(farthest(0.95), 1);
}

// Slowly turned aside it swings with (omega sin(theta_0)), as the textbook's linearised equation has it.
TEST(BeadOnAHoop, SwingsAboutItsPlaceBesideTheBottom) {
  EXPECT_NEAR((*simulated(shipped("bead_on_hoop", {})).final_psi)[0], std::acos(9.81 / 20), 1e-12);
  const double place = std::acos(9.81 / 20), period = 2 * std::numbers::pi / (10 * std::sin(place)),
               away = 1e-4;
  const Experiment experiment = shipped(
      "bead_on_hoop",
      {{"plant.initial", "[" + std::to_string(place + away) + "]"}, {"duration", "1 s"}, {"expect", "{}"}});
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  const auto start = run.recorder().psi(0)[0] - place;
  for (std::int64_t k = 0; k < 1000; k += 50)  // what the small swing leaves out is of second order
    EXPECT_NEAR(run.recorder().psi(k)[0] - place,
                start * std::cos(2 * std::numbers::pi * static_cast<double>(k) * 1e-3 / period), 2e-8)
        << k;
}

TEST(SceneWithoutMotors, IsRefusedWithoutFreeCoordinatesToo) {
  const auto error = input_error([] {
    load_scene(
        parse_document("{transforms: [{from: 0, to: 1}], bodies: [{frame: 1, mass: 1 kg}]}", "scene.yaml"),
        {});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "missing_key");
  EXPECT_NE(error->message.find("neither 'motors' nor 'free'"), std::string::npos);
}

}  // namespace
}  // namespace mixloop
