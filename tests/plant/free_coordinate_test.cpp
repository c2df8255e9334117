// SPDX-License-Identifier: MIT
// A plant of which not all coordinates have a motor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "plant/deadline_plant.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

constexpr double kCraneRate = 1000;

PlantSettings settings_from(const std::string& text) {
  return read_plant_settings(parse_document(text, "plant.yaml"), *crane(), kCraneRate);
}

Plant crane_plant(const PlantSettings& settings) {
  const auto equations =
      equations_of(crane(), Evaluation::interpreter, {Purpose::forward_dynamics, Purpose::linearisation});
  return {{equations, {}}, settings, kCraneRate, std::vector{0.0, 0.0}};
}

double energy(const Plant& plant) {
  const double x = plant.psid()[0], swing = plant.psi()[1], rate = plant.psid()[1];
  const double kinetic = 1.5 * x * x + 0.5 * rate * rate - std::cos(swing) * x * rate;
  return kinetic - 10 * (std::cos(swing) - 1);
}

// 6 N on 2 kg, and the load hangs straight.
TEST(PlantOfACrane, AcceleratesByItsMotor) {
  Plant plant = crane_plant({});
  plant.command(std::array{6.0});
  EXPECT_EQ(plant.psi().size(), 2U);
  EXPECT_EQ(plant.applied().size(), 1U);
  double psidd[2];
  plant.acceleration(psidd);
  EXPECT_NEAR(psidd[0], 3, 1e-12);
  EXPECT_NEAR(psidd[1], 3, 1e-12);
}

// What its motor has done is what the crane has: at the error of each method in a second of ticks.
TEST(PlantOfACrane, HasTheEnergyThatItsMotorHasGiven) {
  for (const auto& [method, most] : {std::pair("rk4", 1e-8), std::pair("rodas4", 1e-4)}) {
    Plant plant = crane_plant(settings_from(std::string("{integrator: ") + method + "}"));
    double swing = 0;
    for (int k = 0; k < 1000; ++k) {
      plant.command(std::array{4 * std::sin(0.004 * k)});
      plant.advance();
      swing = std::max(swing, std::abs(plant.psi()[1]));
    }
    EXPECT_GT(swing, 0.1);
    EXPECT_NEAR(energy(plant), plant.work(), most) << method;
  }
}

TEST(PlantOfACrane, HoldsItsMotorWhereTheCommandsEnded) {
  DeadlineSettings deadline{.max_missed = 2, .kp = Vector{{1000.0}}, .kv = Vector{{100.0}}};
  DeadlinePlant hardware(crane_plant({}), {}, deadline, kCraneRate, 100);
  hardware.command({}, std::array{6.0});
  for (int k = 0; k < 20; ++k) hardware.finish_tick();
  ASSERT_TRUE(hardware.safe());
  EXPECT_EQ(hardware.commanded().size(), 1U);
  EXPECT_LT(hardware.commanded()[0], 0) << "against its motion";
}

TEST(PlantOfACrane, HasASensorForEachCoordinateAndADriveForEachMotor) {
  PlantSettings settings = settings_from(
      "{sensors: {bias: [0.5 m, 0.25]}, actuators: {time_constant: [0.01 s]}, torque_limit: [5], initial: "
      "[1, 2]}");
  EXPECT_EQ(settings.initial_psi, (std::vector{1.0, 2.0}));
  settings.faults.injected = true;
  Plant plant = crane_plant(settings);
  const auto sensor = [](int index) { return Fault{Fault::Target::sensor, Fault::Kind::off, index}; };
  const auto motor = [](int index) { return Fault{Fault::Target::motor, Fault::Kind::off, index}; };
  EXPECT_TRUE(plant.inject(sensor(1)));
  EXPECT_FALSE(plant.inject(sensor(2)));
  EXPECT_TRUE(plant.inject(motor(0)));
  EXPECT_FALSE(plant.inject(motor(1)));
  double psi[2], psid[2];
  plant.measure(psi, psid);
  EXPECT_EQ(psi[0], 0.5);
  EXPECT_EQ(psi[1], 0);
}

TEST(PlantOfACrane, HasItsFaultsByName) {
  const auto fault = [](const std::string& which) {
    return read_faults(parse_document("[{at: 0 s, " + which + ", kind: off}]", "faults.yaml"), *crane(),
                       false, kCraneRate, {})
        .front();
  };
  EXPECT_EQ(fault("motor: trolley").index, 0);
  EXPECT_EQ(fault("sensor: swing").index, 1);
  EXPECT_EQ(fault("sensor: 2").index, 1);
  for (const char* none : {"motor: swing", "motor: 2", "sensor: 3"}) input_error([&] { fault(none); });
}

class BadCranePlant : public testing::TestWithParam<BadInput> {};

TEST_P(BadCranePlant, IsRefused) {
  const auto error = input_error([] { settings_from(GetParam().text); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(error->message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCranePlant,
    testing::Values(BadInput{"TorqueLimit", "{torque_limit: [1, 1]}", "wrong_size", "each of the 1 motors"},
                    BadInput{"Initial", "{initial: [1]}", "wrong_size", "each of the 2 coordinates"},
                    BadInput{"Drives", "{actuators: {rate_limit: [1, 1]}}", "wrong_size",
                             "one for all motors or one for each of the 1"},
                    BadInput{"Sensors", "{sensors: {noise: [1]}}", "wrong_size",
                             "one for all coordinates or one for each of the 2"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
