// SPDX-License-Identifier: MIT
// Drives against closed forms, by themselves and in a plant: a wheel of 1 kg m^2 (rig.hpp).
#include "plant/actuators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/plant/rig.hpp"

namespace mixloop {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
// DOP853 at 1 ms adds less than (h / T)^9 < 1e-11 a tick where torques change over T = 20 ms or more; over
// the 200 ticks of these tests round-off and that stay below 1e-11.
constexpr double kIntegrated = 1e-11;
const PlantSettings kFine{.integrator = Method::dop853};

/// Drives and what they remember.
struct Drives {
  Actuators model;
  Actuators::State state;
  void pass(double s) { model.pass(state, s); }
  double next_kink(double s) const { return model.next_kink(state, s); }
};

double torque(const Drives& drives, double s) {
  const double still[] = {0.0};
  double tau[1];
  drives.model.torque(drives.state, s, still, still, 1, tau);
  return tau[0];
}

Drives stepped(const ActuatorSettings& settings, double from, double to) {
  const Actuators model(settings, 1);
  Drives drives{model, model.state()};
  model.take(drives.state, std::array{from});
  model.take(drives.state, std::array{to});
  return drives;
}

TEST(Actuators, FollowAStepByTheExponentialOfTheirLag) {
  constexpr double kT = 0.02;
  const Drives drives = stepped({.time_constant = {kT}}, 1, 3);
  for (double s = 0; s < 0.2; s += 0.0007)
    EXPECT_NEAR(torque(drives, s), 3 - 2 * std::exp(-s / kT), 4 * kEps * 3) << s;
}

TEST(Actuators, RampAtTheirRateAndStop) {
  const Drives up = stepped({.rate_limit = {10}}, 1, 3), down = stepped({.rate_limit = {10}}, 1, -3);
  for (double s = 0; s < 0.6; s += 0.0007) {
    EXPECT_NEAR(torque(up, s), std::min(1 + 10 * s, 3.0), 2 * kEps * 3) << s;
    EXPECT_NEAR(torque(down, s), std::max(1 - 10 * s, -3.0), 2 * kEps * 3) << s;
  }
  EXPECT_EQ(up.next_kink(0), 0.2);
  EXPECT_EQ(up.next_kink(0.2), HUGE_VAL);
}

// A lag's answer to a ramp that stops at s1 is that to two endless ones: R (g(s) - g(s - s1)), g(s) = s - T
// (1 - exp(-s/T)).
TEST(Actuators, LagBehindTheirRamp) {
  constexpr double kT = 0.02, kR = 40, kEnd = 2 / kR;
  const Drives drives = stepped({.rate_limit = {kR}, .time_constant = {kT}}, 1, 3);
  const auto g = [](double s) { return s > 0 ? s - kT * (1 - std::exp(-s / kT)) : 0; };
  for (double s = 0; s < 0.3; s += 0.0007)
    EXPECT_NEAR(torque(drives, s), 1 + kR * (g(s) - g(s - kEnd)), 16 * kEps * kR * std::max(s, kT)) << s;
}

TEST(Actuators, AreWhereTheyWouldBeHoweverTimeIsCut) {
  Drives whole = stepped({.rate_limit = {40}, .time_constant = {0.02}}, 0, 3), cut = whole;
  whole.pass(0.07);
  for (const double s : {0.011, 0.02, 0.0005, 0.0385}) cut.pass(s);
  EXPECT_NEAR(torque(whole, 0.01), torque(cut, 0.01), 32 * kEps * 3);
}

TEST(Actuators, StartSettledOnTheFirstCommand) {
  Plant plant = rig_plant({.actuators = {.rate_limit = {1, 1}, .time_constant = {1, 1}}});
  const double tau[] = {2, -3};
  plant.command(tau);
  EXPECT_EQ(plant.applied()[0], 2);
  EXPECT_EQ(plant.applied()[1], -3);
}

// w = u (t - T (1 - e^(-t/T))), psi = u (t^2/2 - T t + T^2 (1 - e^(-t/T))), t from where the step acts: after
// the dead time, which comes first and isn't a whole number of ticks.
TEST(Actuators, TurnAWheelByTheIntegralsOfALaggedStep) {
  constexpr double kT = 0.02, kU = 5, kDead = 0.0024;
  PlantSettings settings = kFine;
  settings.actuators.time_constant = {kT, kT};
  settings.command_delay = kDead;
  Plant plant = rig_plant(settings);
  go_on(plant, 1, 0);
  go_on(plant, 199, kU);
  const double t = 0.199 - kDead, rise = 1 - std::exp(-t / kT);
  EXPECT_NEAR(plant.psid()[0], kU * (t - kT * rise), kIntegrated);
  EXPECT_NEAR(plant.psi()[0], kU * (t * t / 2 - kT * t + kT * kT * rise), kIntegrated);
  EXPECT_NEAR(plant.applied()[0], kU * rise, kIntegrated);
}

// RK4 is exact on a ramp and on what is constant; the corner between the two lies within a tick, at 13.7 ms.
TEST(Actuators, CutTheTickWhereARampEnds) {
  constexpr double kU = 2, kCorner = 0.0137;
  Plant plant = rig_plant({.actuators = {.rate_limit = {kU / kCorner, 1}}});
  go_on(plant, 1, 0);
  go_on(plant, 30, kU);
  EXPECT_NEAR(plant.psid()[0], kU * (0.030 - kCorner / 2), 30 * kEps);
}

// 1/2 w^2 = u (psi + A / N (1 - cos(N psi)))
TEST(Actuators, RippleWithTheAngle) {
  constexpr double kA = 0.3, kN = 4, kU = 5;
  for (const bool continuous : {false, true}) {
    PlantSettings settings = kFine;
    settings.actuators = {.ripple = {kA, 0}, .ripple_per_turn = {kN, 1}};
    settings.continuous = continuous;
    Plant plant = rig_plant(settings);
    for (int k = 0; k < 1000; ++k) {
      const double tau[] = {kU, 0};
      plant.command(tau);
      if (continuous)
        plant.advance_continuously(
            [](int, double, auto, auto, std::span<double> out) { out[0] = kU, out[1] = 0; });
      else
        plant.advance();
    }
    const double psi = plant.psi()[0], w = plant.psid()[0];
    EXPECT_GT(psi, 1);
    EXPECT_NEAR(w * w / 2, kU * (psi + kA / kN * (1 - std::cos(kN * psi))), 20 * kIntegrated);
    EXPECT_NEAR(plant.work(), w * w / 2, 20 * kIntegrated) << "the torque that really acts does the work";
    EXPECT_EQ(plant.applied()[0], kU * (1 + kA * std::sin(kN * psi)));
  }
}

// w = u / b (1 - e^(-b t)) as it comes up, w0 e^(-b t) as it runs down.
TEST(Actuators, RunDownByViscousFriction) {
  constexpr double kB = 3, kU = 5;
  PlantSettings settings = kFine;
  settings.actuators.viscous = {kB, 0};
  Plant plant = rig_plant(settings);
  go_on(plant, 100, kU);
  const double w0 = kU / kB * (1 - std::exp(-kB * 0.1));
  EXPECT_NEAR(plant.psid()[0], w0, kIntegrated);
  go_on(plant, 100, 0);
  EXPECT_NEAR(plant.psid()[0], w0 * std::exp(-kB * 0.1), kIntegrated);
  EXPECT_NEAR(plant.work(), plant.psid()[0] * plant.psid()[0] / 2, kIntegrated);
}

// w' = -c tanh(w / v): sinh(w / v) = sinh(w0 / v) e^(-c t / v)
TEST(Actuators, RunDownBySmoothedCoulombFriction) {
  constexpr double kC = 0.5, kV = 0.1;
  PlantSettings settings = kFine;
  settings.actuators.coulomb = {kC, 0};
  settings.actuators.smooth = {kV, kV};
  Plant plant = rig_plant(settings);
  go_on(plant, 100, 5);
  const double w0 = plant.psid()[0];
  EXPECT_GT(w0, 0.4);
  for (int k = 1; k <= 10; ++k) {
    go_on(plant, 100, 0);
    const double expected = kV * std::asinh(std::sinh(w0 / kV) * std::exp(-kC * 0.1 * k / kV));
    EXPECT_NEAR(plant.psid()[0], expected, 10 * kIntegrated) << k;
  }
}

// Every effect at once: what the drives put in is what the wheel has, the error of RK4 at 0.1 ms left.
TEST(Actuators, PutTheWorkThatTheyDoIntoTheMechanism) {
  PlantSettings settings{.substeps = 10, .torque_limit = {4, 4}};
  settings.actuators = {.rate_limit = {200, 200},
                        .time_constant = {0.01, 0},
                        .ripple = {0.1, 0},
                        .ripple_per_turn = {12, 1},
                        .viscous = {0.2, 0.1},
                        .coulomb = {0.1, 0.1},
                        .smooth = {0.1, 0.1}};
  Plant plant = rig_plant(settings);
  for (int k = 0; k < 400; ++k) go_on(plant, 1, 6 * std::sin(0.02 * k), 3 * std::cos(0.01 * k));
  const double w = plant.psid()[0], v = plant.psid()[1];
  EXPECT_GT(w * w / 2 + v * v, 0.01);
  EXPECT_NEAR(plant.work(), w * w / 2 + v * v, 1e-9);
}

TEST(Actuators, GiveTheBytesOfIdealOnesWhereTheyDoNothing) {
  Plant ideal = rig_plant({.substeps = 3, .command_delay = 0.0004});
  Plant idle = rig_plant({.substeps = 3,
                          .command_delay = 0.0004,
                          .sensors = {.bias = {0, 0}},
                          .actuators = {.time_constant = {0, 0}, .viscous = {0, 0}},
                          .faults = {.injected = true}});
  for (int k = 0; k < 100; ++k)
    for (Plant* plant : {&ideal, &idle}) go_on(*plant, 1, std::sin(0.3 * k), 1.0 / (k + 1));
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(ideal.psi()[i], idle.psi()[i]);
    EXPECT_EQ(ideal.psid()[i], idle.psid()[i]);
  }
  EXPECT_EQ(ideal.work(), idle.work());
}

}  // namespace
}  // namespace mixloop
