// SPDX-License-Identifier: MIT
// Motors that are locked while what is free moves on: a load of 1 kg on 1 m under a trolley of 2 kg, g = 10,
//   M = [3, -cos; -cos, 1],  h = (sin swing'^2, 10 sin)
#include "plant/held_motors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "plant/deadline_plant.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

constexpr double kSwing = 0.5, kTrolleyRate = 2, kSwingRate = 1;

DeadlinePlant swinging(Method method) {
  PlantSettings settings{.integrator = method};
  Plant plant({plant_equations(crane(), Evaluation::interpreter, settings), {}}, settings, 1000,
              std::array{0.25, kSwing}, std::array{kTrolleyRate, kSwingRate});
  return {std::move(plant), settings, {.safe_state = SafeState::brake}, 1000, 2000};
}

TEST(HeldMotors, AccelerateNotAndLetTheFreeOnesFall) {
  Equations::Workspace dynamics(
      equations_of(crane(), Evaluation::interpreter, {Purpose::mass_matrix, Purpose::forward_dynamics}), {});
  const std::vector psi{0.25, kSwing}, psid{0.0, kSwingRate};
  HeldMotors held(2, 1);
  held.look(dynamics, psi, 0);
  Vector a(2);
  dynamics.evaluate(Purpose::forward_dynamics, {psi, psid, std::array{0.0}, 0}, span_of(a));
  // What keeps the trolley: 3 x'' - cos swing'' + sin swing'^2, x'' = 0, swing'' = -10 sin.
  EXPECT_NEAR(held.torque(a)[0], 10 * std::sin(kSwing) * std::cos(kSwing) + std::sin(kSwing), 1e-14);
  held.hold(a);
  EXPECT_EQ(a[0], 0);
  EXPECT_NEAR(a[1], -10 * std::sin(kSwing), 1e-14);
}

// The impulse is the trolley's alone: swing' - cos x' of the load stays.
TEST(HeldMotors, StopByAnImpulseOfTheirOwn) {
  DeadlinePlant hardware = swinging(Method::rk4);
  hardware.make_safe("a test");
  EXPECT_EQ(hardware.plant().psid()[0], 0);
  EXPECT_NEAR(hardware.plant().psid()[1], kSwingRate - std::cos(kSwing) * kTrolleyRate, 1e-15);
  EXPECT_EQ(hardware.plant().psi()[0], 0.25);
}

// A pendulum of 1 m from then on: its energy stays, and it comes to where it would.
TEST(HeldMotors, LeaveAPendulumThatSwingsOn) {
  const auto after = [](Method method, int ticks) {
    DeadlinePlant hardware = swinging(method);
    hardware.make_safe("a test");
    const double work = hardware.plant().work();
    for (int k = 0; k < ticks; ++k) hardware.finish_tick();
    EXPECT_EQ(hardware.plant().psi()[0], 0.25);
    EXPECT_EQ(hardware.plant().psid()[0], 0);
    EXPECT_EQ(hardware.plant().work(), work);
    return std::pair(hardware.plant().psi()[1], hardware.plant().psid()[1]);
  };
  const double first = kSwingRate - std::cos(kSwing) * kTrolleyRate;
  const double energy = first * first / 2 - 10 * std::cos(kSwing);
  const auto exact = after(Method::dop853, 1000);
  EXPECT_NEAR(exact.second * exact.second / 2 - 10 * std::cos(exact.first), energy, 1e-12);
  for (const auto& [method, most] :
       {std::pair(Method::rk4, 1e-10), std::pair(Method::gauss8, 1e-12), std::pair(Method::rodas4, 1e-8)}) {
    const auto found = after(method, 1000);
    EXPECT_NEAR(found.first, exact.first, most) << static_cast<int>(method);
    EXPECT_NEAR(found.second, exact.second, 10 * most) << static_cast<int>(method);
  }
}

TEST(HeldMotors, HoldAllThatAreDriven) {
  const auto driven = crane(false);
  PlantSettings settings;
  Plant plant({plant_equations(driven, Evaluation::interpreter, settings), {}}, settings, 1000,
              std::array{0.25, kSwing}, std::array{kTrolleyRate, kSwingRate});
  plant.lock();
  for (int k = 0; k < 10; ++k) plant.advance();
  EXPECT_EQ(plant.psi()[1], kSwing);
  EXPECT_EQ(plant.psid()[1], 0);
}

}  // namespace
}  // namespace mixloop
