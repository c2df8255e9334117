// SPDX-License-Identifier: MIT
// Faults of a plant: when they begin and end, and what they do to it.
#include "plant/faults.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/plant/rig.hpp"
#include "tests/support/allocation_counter.hpp"

namespace mixloop {
namespace {

using Kind = Fault::Kind;
using Target = Fault::Target;

constexpr double kSumsUp = 1e-11;  // DOP853 at 1 ms of rates of a few 1/s, over hundreds of ticks

PlantSettings with_faults(std::vector<Fault> scheduled, Method method = Method::rk4) {
  PlantSettings settings{.integrator = method};
  settings.faults.scheduled = std::move(scheduled);
  return settings;
}

/// The wheel's torque tick by tick, k + 1 commanded at tick k.
std::vector<double> torques(Plant& plant, int ticks) {
  std::vector<double> all;
  for (int k = 0; k < ticks; ++k) {
    const double tau[] = {k + 1.0, -1};
    plant.command(tau);
    all.push_back(plant.applied()[0]);
    EXPECT_EQ(plant.applied()[1], -1) << "the other motor's";
    plant.advance();
  }
  return all;
}

TEST(Faults, BeginAtTheirTickAndLastAsLongAsTheySay) {
  Plant plant = rig_plant(with_faults({{.kind = Kind::off, .index = 0, .at = 0.003, .duration = 0.002}}));
  EXPECT_EQ(torques(plant, 8), (std::vector<double>{1, 2, 3, 0, 0, 6, 7, 8}));
}

TEST(Faults, BetweenTicksBeginWithTheNext) {
  Plant plant = rig_plant(with_faults({{.kind = Kind::off, .index = 0, .at = 0.0021, .duration = 0.0015}}));
  EXPECT_EQ(torques(plant, 8), (std::vector<double>{1, 2, 3, 0, 0, 6, 7, 8}));
}

TEST(Faults, StayUntilHealed) {
  Plant plant = rig_plant(with_faults(
      {{.kind = Kind::stuck, .index = 0, .at = 0.002}, {.kind = Kind::none, .index = 0, .at = 0.006}}));
  EXPECT_EQ(torques(plant, 8), (std::vector<double>{1, 2, 2, 2, 2, 2, 7, 8}));
}

TEST(Faults, TakeAnEarlierOnesPlace) {
  Plant plant = rig_plant(
      with_faults({{.kind = Kind::wrong, .index = 0, .magnitude = 10, .at = 0.001, .duration = 0.004},
                   {.kind = Kind::off, .index = 0, .at = 0.003, .duration = 0.001}}));
  EXPECT_EQ(torques(plant, 6), (std::vector<double>{1, 12, 13, 0, 5, 6}));
}

TEST(Faults, OfMotorsComeBeforeSaturationAndAfterDeadTime) {
  PlantSettings settings =
      with_faults({{.kind = Kind::wrong, .index = 0, .magnitude = 10, .at = 0.003, .duration = 0.002}});
  settings.command_delay = 0.002;
  settings.torque_limit = {8, 8};
  Plant plant = rig_plant(settings);
  EXPECT_EQ(torques(plant, 8), (std::vector<double>{1, 1, 1, 8, 8, 4, 5, 6}));
}

TEST(Faults, OfAllStrikeAll) {
  Plant plant = rig_plant(with_faults({{.kind = Kind::off}}));
  const double tau[] = {1, 2};
  plant.command(tau);
  EXPECT_EQ(plant.applied()[0], 0);
  EXPECT_EQ(plant.applied()[1], 0);
}

TEST(Faults, OfSensorsChangeWhatIsMeasuredNotWhatIs) {
  Plant plant =
      rig_plant(with_faults({{.target = Target::sensor, .kind = Kind::wrong, .index = 1, .magnitude = 0.5},
                             {.target = Target::sensor, .kind = Kind::stuck, .index = 0, .at = 0.001}}));
  double psi[2], psid[2];
  for (int k = 0; k < 5; ++k) {
    EXPECT_FALSE(plant.measure(psi, psid));
    EXPECT_EQ(psi[0], 0);
    EXPECT_EQ(psid[0], 0) << "stuck before it moved";
    EXPECT_EQ(psi[1], plant.psi()[1] + 0.5);
    EXPECT_EQ(psid[1], plant.psid()[1]) << "from a wrong zero the velocity is right";
    go_on(plant, 1, 1, 1);
  }
  EXPECT_GT(plant.psi()[0], 0);
}

TEST(Faults, OfDifferentiatingSensorsGoIntoTheVelocity) {
  PlantSettings settings = with_faults(
      {{.target = Target::sensor, .kind = Kind::wrong, .index = 0, .magnitude = 0.5, .at = 0.002}});
  settings.sensors.differentiated = true;
  Plant plant = rig_plant(settings);
  double psi[2], psid[2];
  for (int k = 0; k < 5; ++k) {
    plant.measure(psi, psid);
    EXPECT_EQ(psid[0], k == 2 ? 500 : 0) << k;
    go_on(plant, 1, 0);
  }
}

// w' = u / (1 + m): the wheel is heavier for 100 ticks.
TEST(Faults, ChangeAParameterAndGiveItBack) {
  Plant plant = rig_plant(with_faults({{.target = Target::parameter,
                                        .kind = Kind::changed,
                                        .index = 0,
                                        .magnitude = 3,
                                        .at = 0.1,
                                        .duration = 0.1}}));
  go_on(plant, 100, 2);
  EXPECT_NEAR(plant.psid()[0], 0.2, 1e-14);  // a few hundred roundings of numbers below 1
  EXPECT_TRUE(plant.faults()->active);
  EXPECT_EQ(plant.faults()->changed_at, 100);
  EXPECT_EQ(plant.faults()->parameters[0], 3);
  go_on(plant, 100, 2);
  EXPECT_NEAR(plant.psid()[0], 0.25, 1e-14);
  EXPECT_FALSE(plant.faults()->active);
  go_on(plant, 100, 2);
  EXPECT_NEAR(plant.psid()[0], 0.45, 1e-14);
}

// w' = u - f d w, whichever way it is integrated and whether the friction is the scene's or the drive's.
TEST(Faults, ScaleFriction) {
  constexpr double kD = 3, kF = 2.5, kU = 5;
  for (const Method method : {Method::dop853, Method::rodas4, Method::gauss8})
    for (const bool drive : {false, true}) {
      if (drive && method == Method::rodas4) continue;
      PlantSettings settings = with_faults(
          {{.target = Target::friction, .kind = Kind::changed, .magnitude = kF, .at = 0.1}}, method);
      settings.substeps = method == Method::rodas4 ? 10 : 1;
      if (drive) settings.actuators.viscous = {kD, 0};
      Plant plant = rig_plant(settings, drive ? 0 : kD);
      go_on(plant, 100, kU);
      const double w0 = kU / kD * -std::expm1(-kD * 0.1);
      // RODAS4 at 0.1 ms: 0.2 (h f d)^4 a second
      const double tolerance = method == Method::rodas4 ? 1e-10 : kSumsUp;
      EXPECT_NEAR(plant.psid()[0], w0, tolerance) << facts(method).name;
      go_on(plant, 100, kU);
      const double end = kU / (kF * kD), w = plant.psid()[0];
      EXPECT_NEAR(w, end + (w0 - end) * std::exp(-kF * kD * 0.1), tolerance) << facts(method).name;
      double psidd[2];
      plant.acceleration(psidd);
      EXPECT_NEAR(psidd[0], kU - kF * kD * w, 1e-13);
    }
}

TEST(Faults, AreInjectedAtOnceOrLaterWhereThatIsAllowed) {
  Plant closed = rig_plant({}), listed = rig_plant(with_faults({{.kind = Kind::off}}));
  EXPECT_FALSE(closed.inject({.kind = Kind::off}));
  EXPECT_FALSE(listed.inject({.kind = Kind::off}));

  Plant plant = rig_plant({.faults = {.injected = true}});
  go_on(plant, 5, 7);
  EXPECT_TRUE(plant.inject({.kind = Kind::off, .index = 0, .duration = 0.002}));
  EXPECT_EQ(plant.applied()[0], 0) << "at once";
  EXPECT_TRUE(plant.inject({.kind = Kind::wrong, .index = 0, .magnitude = 1, .at = 0.009}));
  std::vector<double> all;
  for (int k = 5; k < 11; ++k) {
    const double tau[] = {7, 0};
    plant.command(tau);
    all.push_back(plant.applied()[0]);
    plant.advance();
  }
  EXPECT_EQ(all, (std::vector<double>{0, 0, 7, 7, 8, 8}));
  EXPECT_TRUE(plant.inject({.kind = Kind::none, .index = 0}));
  EXPECT_EQ(plant.applied()[0], 7);
}

TEST(Faults, ThatCannotBeAreNotInjected) {
  Plant plant = rig_plant({.faults = {.injected = true}});
  const double nan = std::nan("");
  for (const Fault& fault :
       {Fault{.kind = Kind::off, .index = 2}, Fault{.kind = Kind::off, .index = -2},
        Fault{.kind = Kind::garbage, .magnitude = 0}, Fault{.kind = Kind::wrong, .magnitude = nan},
        Fault{.kind = Kind::off, .at = nan}, Fault{.kind = Kind::off, .duration = -1},
        Fault{.kind = Kind::slow, .magnitude = -1}, Fault{.kind = Kind::delayed, .magnitude = 2},
        Fault{.kind = Kind::intermittent, .magnitude = 1.5}, Fault{.kind = Kind::changed},
        Fault{.kind = static_cast<Kind>(99)},
        Fault{.target = Target::parameter, .kind = Kind::changed, .index = 0, .magnitude = -1},
        Fault{.target = Target::parameter, .kind = Kind::changed, .index = 1, .magnitude = 2},
        Fault{.target = Target::parameter, .kind = Kind::changed, .index = 2, .magnitude = 2},
        Fault{.target = Target::parameter, .kind = Kind::changed, .index = -1, .magnitude = 2},
        Fault{.target = Target::parameter, .kind = Kind::off, .index = 0},
        Fault{.target = Target::friction, .kind = Kind::changed, .magnitude = -1},
        Fault{.target = static_cast<Target>(99), .kind = Kind::off}})
    EXPECT_FALSE(plant.inject(fault))
        << static_cast<int>(fault.target) << " " << static_cast<int>(fault.kind);
  for (std::size_t i = 0; i < Faults::kWaiting; ++i) EXPECT_TRUE(plant.inject({.kind = Kind::off, .at = 1}));
  EXPECT_FALSE(plant.inject({.kind = Kind::off, .at = 1})) << "no more can wait";
  EXPECT_TRUE(plant.inject({})) << "what heals at once needn't";
}

TEST(Faults, AndAllElseAllocateNothing) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  PlantSettings settings{.torque_limit = {2, 2}};
  settings.sensors = {.resolution = {1e-3, 1e-3},
                      .noise = {1e-3, 1e-3},
                      .delay = {2, 1},
                      .drop = {0.1, 0.1},
                      .differentiated = true,
                      .velocity_filter = 100};
  settings.actuators = {.rate_limit = {100, 100},
                        .time_constant = {0.001, 0},
                        .ripple = {0.1, 0},
                        .ripple_per_turn = {6, 1},
                        .viscous = {0.1, 0.1},
                        .coulomb = {0.1, 0.1},
                        .smooth = {1, 1}};
  settings.faults.injected = true;
  for (const double at : {0.002, 0.004, 0.006})
    settings.faults.scheduled.push_back(
        {.kind = Kind::delayed, .magnitude = 0.002, .at = at, .duration = 0.001});
  Plant plant = rig_plant(settings, 0.5);
  double psi[2], psid[2];
  const AllocationCounter counter;
  for (int k = 0; k < 12; ++k) {
    plant.measure(psi, psid);
    plant.inject({.target = Target::sensor, .kind = Kind::garbage, .magnitude = 1, .duration = 0.001});
    plant.inject({.target = Target::friction, .kind = Kind::changed, .magnitude = 2.0 + k});
    plant.inject({.target = Target::parameter, .kind = Kind::changed, .index = 0, .magnitude = 1.0 + k});
    go_on(plant, 1, std::sin(k), 1);
  }
  EXPECT_EQ(counter.count(), 0U) << counter.first_caller();
}

}  // namespace
}  // namespace mixloop
