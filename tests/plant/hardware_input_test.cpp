// SPDX-License-Identifier: MIT
// What an experiment may say of sensors, actuators and faults.
#include <gtest/gtest.h>

#include <filesystem>

#include "loop/experiment.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

const std::string kHead = R"(scene: scenes/mixed_loop_robot.yaml
path: {line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, profile: cycloidal, duration: 1 s}
controller: {law: pd, kp: [100, 25, 25], kv: [1.0, 0.5, 0.5]}
)";

Experiment read(const std::string& text, const std::string& file = "bad.yaml") {
  return load_experiment(parse_document(text, file), std::filesystem::path(MIXLOOP_SOURCE) / file, {});
}

TEST(Hardware, IsReadFromAnExperiment) {
  const Experiment experiment = read(kHead + R"(plant:
  sensors: {resolution: 0.1 deg, noise: [1e-4, 2e-4, 3e-4], bias: 1 deg, delay: 3 ms, drop: 1e-3,
            velocity: differentiated, velocity_filter: 200 Hz}
  actuators:
    rate_limit: 500 N m/s
    time_constant: [1 ms, 0 s, 2 ms]
    ripple: {amplitude: 0.05, per_turn: 12}
    friction: {viscous: 0.01 N m s, coulomb: 0.1 N m, smooth: 0.2 rad/s}
seed: 7
faults:
  - {at: 0.3 s, for: 0.2 s, motor: psi2, kind: stuck}
  - {at: 0.3 s, sensor: 3, kind: wrong, magnitude: 0.5 deg}
  - {at: 0.4 s, motor: all, kind: slow, magnitude: 5 ms}
  - {at: 0.5 s, parameter: payload, value: 2 kg}
  - {at: 0.6 s, friction: 3}
)");
  const PlantSettings& plant = experiment.plant;
  EXPECT_EQ(plant.sensors.resolution, std::vector(3, std::atan(1) / 45 / 10));
  EXPECT_EQ(plant.sensors.noise, (std::vector{1e-4, 2e-4, 3e-4}));
  EXPECT_EQ(plant.sensors.delay, (std::vector<std::int64_t>{3, 3, 3}));
  EXPECT_TRUE(plant.sensors.differentiated);
  EXPECT_EQ(plant.sensors.velocity_filter, 200);
  EXPECT_EQ(plant.actuators.rate_limit, std::vector(3, 500.0));
  EXPECT_EQ(plant.actuators.time_constant, (std::vector{0.001, 0.0, 0.002}));
  EXPECT_EQ(plant.actuators.ripple_per_turn, std::vector(3, 12.0));
  EXPECT_EQ(plant.actuators.smooth, std::vector(3, 0.2));
  EXPECT_EQ(plant.seed, 7U);
  EXPECT_TRUE(plant.random());
  ASSERT_EQ(plant.faults.scheduled.size(), 5U);
  const auto& faults = plant.faults.scheduled;
  EXPECT_EQ(faults[0].index, 1);
  EXPECT_EQ(faults[0].kind, Fault::Kind::stuck);
  EXPECT_EQ(faults[0].duration, 0.2);
  EXPECT_EQ(faults[1].index, 2);
  EXPECT_EQ(faults[1].target, Fault::Target::sensor);
  EXPECT_EQ(faults[2].index, -1);
  EXPECT_EQ(faults[2].magnitude, 0.005);
  EXPECT_EQ(faults[3].target, Fault::Target::parameter);
  EXPECT_EQ(faults[3].magnitude, 2);
  EXPECT_EQ(faults[4].target, Fault::Target::friction);
  EXPECT_EQ(faults[4].magnitude, 3);
}

TEST(Hardware, IsIdealUnlessToldOtherwise) {
  const PlantSettings plant = read(kHead).plant;
  EXPECT_FALSE(plant.sensors.any() || plant.actuators.any() || plant.faults.any() || plant.random());
}

TEST(Hardware, KeepsItsGeometryInARun) {
  const auto error = input_error([] {
    load_experiment(std::filesystem::path(MIXLOOP_SOURCE) / "experiments/paper.yaml",
                    {{"scene", "../tests/stress/robot_of_parameters.yaml"},
                     {"faults", "[{at: 0.5 s, parameter: L2, value: 31 cm}]"}});
  });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, "out_of_range");
  EXPECT_NE(error->message.find("the mechanism's geometry depends on 'L2'"), std::string::npos)
      << error->message;
}

class BadHardware : public testing::TestWithParam<BadInput> {};

TEST_P(BadHardware, IsRefusedAtItsPlace) {
  BadInput row = GetParam();
  row.text = kHead + row.text;
  expect_refused(row, [](const std::string& text, const std::string& file) { read(text, file); });
}

INSTANTIATE_TEST_SUITE_P(
    Rows, BadHardware,
    testing::Values(
        BadInput{"sensor_key", "plant: {sensors: {@resolutoin: 1}}", "unknown_key",
                 "did you mean 'resolution'"},
        BadInput{"resolution_unit", "plant: {sensors: {resolution: @1 mm}}", "wrong_dimension", "resolution"},
        BadInput{"negative_noise", "plant: {sensors: {noise: [0, @-1, 0]}}", "out_of_range",
                 "expected 0 or more"},
        BadInput{"two_values", "plant: {sensors: {bias: @[1, 2]}}", "wrong_size", "one for each of the 3"},
        BadInput{"delay_off_grid", "plant: {sensors: {delay: @1.5 ms}}", "out_of_range", "1.5 ticks"},
        BadInput{"long_delay", "plant: {sensors: {delay: @2 s}}", "out_of_range", "0 to 1 s"},
        BadInput{"many_ticks_of_delay", "rate: 100 kHz\nplant: {sensors: {delay: @0.5 s}}", "out_of_range",
                 "up to 10000"},
        BadInput{"probability", "plant: {sensors: {drop: @1.1}}", "out_of_range", "a probability"},
        BadInput{"velocity", "plant: {sensors: {velocity: @guessed}}", "unknown_value", "velocity"},
        BadInput{"filter_alone", "plant: {sensors: {velocity_filter: @10 Hz}}", "unknown_key",
                 "velocity: differentiated"},
        BadInput{"filter", "plant: {sensors: {velocity: differentiated, velocity_filter: @0 Hz}}",
                 "out_of_range", "a positive frequency"},
        BadInput{"sensors_continuous", "plant: {control: continuous, sensors: @{bias: 1}}", "out_of_range",
                 "control: held"},
        BadInput{"actuator_key", "plant: {actuators: {@lag: 1}}", "unknown_key", "actuators"},
        BadInput{"rate", "plant: {actuators: {rate_limit: @0}}", "out_of_range", "a positive value"},
        BadInput{"rate_unit", "plant: {actuators: {rate_limit: @3 N m}}", "wrong_dimension", "rate limit"},
        BadInput{"lag", "plant: {actuators: {time_constant: @-1 ms}}", "out_of_range", "0 or more"},
        BadInput{"ripple", "plant: {actuators: {ripple: {amplitude: @2, per_turn: 4}}}", "out_of_range",
                 "0 to 1"},
        BadInput{"ripple_of_what", "plant: {actuators: {ripple: @{amplitude: 0.1}}}", "missing_key",
                 "per_turn"},
        BadInput{"viscous", "plant: {actuators: {friction: {viscous: @-1}}}", "out_of_range", "0 or more"},
        BadInput{"smooth_alone", "plant: {actuators: {friction: {smooth: @1}}}", "unknown_key", "coulomb"},
        BadInput{"lag_continuous", "plant: {control: continuous, actuators: @{time_constant: 1 ms}}",
                 "out_of_range", "ripple and friction alone"},
        BadInput{"jacobian", "plant: {integrator: rodas4, actuators: @{time_constant: 1 ms}}", "out_of_range",
                 "rodas4 takes the Jacobian"},
        BadInput{"seed", "seed: @-1", "out_of_range", "the seed"},
        BadInput{"no_list", "faults: @{at: 1}", "wrong_kind", "expected a list"},
        BadInput{"fault_key", "faults: [{at: 1, @motr: 2}]", "unknown_key", "did you mean 'motor'"},
        BadInput{"no_target", "faults: [@{at: 1, kind: off}]", "missing_key", "one of motor, sensor"},
        BadInput{"two_targets", "faults: [@{at: 1, motor: 1, sensor: 1, kind: off}]", "missing_key",
                 "one of motor"},
        BadInput{"no_time", "faults: [@{motor: 1, kind: off}]", "missing_key", "at"},
        BadInput{"early", "faults: [{at: @-1, motor: 1, kind: off}]", "out_of_range", "before tick 0"},
        BadInput{"for_nothing", "faults: [{at: 0, for: @0, motor: 1, kind: off}]", "out_of_range",
                 "doesn't last"},
        BadInput{"between_ticks", "faults: [{at: 0.2 ms, for: @0.3 ms, motor: 1, kind: off}]", "out_of_range",
                 "no tick lies within"},
        BadInput{"motor_number", "faults: [{at: 0, motor: @4, kind: off}]", "out_of_range", "from 1 to 3"},
        BadInput{"motor_zero", "faults: [{at: 0, motor: @0, kind: off}]", "out_of_range", "from 1 to 3"},
        BadInput{"motor_name", "faults: [{at: 0, motor: @psi22, kind: off}]", "unknown_value", "psi2"},
        BadInput{"kind", "faults: [{at: 0, motor: 1, kind: @stuk}]", "unknown_value", "stuck"},
        BadInput{"no_kind", "faults: [@{at: 0, motor: 1}]", "missing_key", "kind"},
        BadInput{"no_magnitude", "faults: [@{at: 0, motor: 1, kind: wrong}]", "missing_key", "magnitude"},
        BadInput{"idle_magnitude", "faults: [{at: 0, motor: 1, kind: off, magnitude: @1}]", "unknown_key",
                 "says nothing"},
        BadInput{"magnitude_unit", "faults: [{at: 0, sensor: 1, kind: wrong, magnitude: @1 N m}]",
                 "wrong_dimension", "magnitude"},
        BadInput{"garbage", "faults: [{at: 0, motor: 1, kind: garbage, magnitude: @0}]", "out_of_range",
                 "not positive"},
        BadInput{"dead_time", "faults: [{at: 0, motor: 1, kind: delayed, magnitude: @2 s}]", "out_of_range",
                 "dead time"},
        BadInput{"share", "faults: [{at: 0, motor: 1, kind: intermittent, magnitude: @1.5}]", "out_of_range",
                 "share"},
        BadInput{"parameter", "faults: [{at: 0, parameter: @payloda, value: 1}]", "unknown_value", "payload"},
        BadInput{"no_value", "faults: [@{at: 0, parameter: payload}]", "missing_key", "value"},
        BadInput{"negative_mass", "faults: [{at: 0, parameter: payload, value: @-1 kg}]", "negative_mass",
                 "with this value"},
        BadInput{"kind_of_change", "faults: [{at: 0, parameter: payload, kind: @stuck, value: 1}]",
                 "unknown_key", "a motor or sensor"},
        BadInput{"no_friction", "faults: [{at: 0, friction: @2}]", "out_of_range", "neither the scene nor"},
        BadInput{"motors_continuous", "plant: {control: continuous}\nfaults: @[{at: 0, motor: 1, kind: off}]",
                 "out_of_range", "parameters and friction alone"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
