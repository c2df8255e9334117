// SPDX-License-Identifier: MIT
// Which free coordinates are measured, and what a controller makes of those that are.
#include "loop/measured.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A cart, a pole on it, and another one on that.
constexpr const char* kCarts = R"(
name: double pole
motors: {cart: linear}
free: [first, second]
transforms:
  - {from: 0, to: cart, prismatic: cart, axis: [1, 0, 0]}
  - {from: cart, to: first, revolute: first, axis: [0, 1, 0]}
  - {from: first, to: second, at: [0, 0, -1], revolute: second, axis: [0, 1, 0]}
bodies:
  - {frame: cart, mass: 2 kg}
  - {frame: first, mass: 1 kg, center_of_mass: [0, 0, -0.5], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  - {frame: second, mass: 1 kg, center_of_mass: [0, 0, -0.5], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
gravity: [0, 0, -10]
end_effector: {frame: cart, axes: [x]}
)";

/// The same taken for a cart alone.
constexpr const char* kRigid = R"(
name: cart
motors: {cart: linear}
transforms: [{from: 0, to: cart, prismatic: cart, axis: [1, 0, 0]}]
bodies: [{frame: cart, mass: 4 kg}]
gravity: [0, 0, -10]
end_effector: {frame: cart, axes: [x]}
)";

class Measured : public testing::Test {
 protected:
  Measured() { folder_.write("carts.yaml", kCarts), folder_.write("rigid.yaml", kRigid); }

  Experiment load(const std::string& text) const {
    const std::string file = folder_.file("experiment.yaml");
    Experiment experiment = load_experiment(parse_document("scene: carts.yaml\n" + text, file), file, {});
    experiment.evaluation = Evaluation::interpreter;
    return experiment;
  }

  const ScratchFolder folder_;
};

std::string fed_back(const std::string& gain, const std::string& sensors) {
  return "duration: 0.5 s\ncontroller: {law: state_feedback, gain: [[" + gain +
         "]]}\nplant: {initial: [0, 0.2, -0.1], sensors: {" + sensors + "}}\n";
}

TEST_F(Measured, AreAllUnlessSomeAreNamed) {
  EXPECT_THAT(measured_coordinates(load(fed_back("1, 0, 0, 1, 0, 0", ""))), ElementsAre(0, 1, 2));
  EXPECT_THAT(measured_coordinates(load(fed_back("1, 0, 0, 1, 0, 0", "free: [second]"))), ElementsAre(0, 2));
  EXPECT_THAT(measured_coordinates(load(fed_back("1, 0, 0, 1, 0, 0", "free: []"))), ElementsAre(0));
}

TEST_F(Measured, StandInTheirPlacesInWhatAControllerSees) {
  const Experiment experiment = load(fed_back("1, 0, 3, 4, 0, 6", "free: [second]"));
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  const Measurement seen = run.measure();
  EXPECT_THAT(seen.psi, ElementsAre(0, -0.1));
  std::array<double, 1> tau{};
  make_controller(experiment).torque({std::array{2.0, 3.0}, std::array{4.0, 5.0}}, plan.at(0), tau);
  EXPECT_EQ(tau[0], -(1 * 2.0 + 3 * 3.0 + 4 * 4.0 + 6 * 5.0));
}

// A zero in the gain and no sensor are the same.
TEST_F(Measured, MakeNoDifferenceToALawThatDoesNotTakeThem) {
  const std::string gain = "20, 0, -3, 8, 0, -1";
  const auto all = simulated(load(fed_back(gain, ""))),
             some = simulated(load(fed_back(gain, "free: [second]")));
  EXPECT_EQ(all.trajectory_sha256, some.trajectory_sha256);
}

// With noise, too: a coordinate's chance is its own.
TEST_F(Measured, HaveTheNoiseThatTheyHave) {
  const std::string gain = "20, 0, -3, 8, 0, -1", noise = "noise: [1e-3 m, 1e-3, 1e-3]";
  const auto all = simulated(load(fed_back(gain, noise))),
             some = simulated(load(fed_back(gain, "free: [second], " + noise)));
  EXPECT_EQ(all.trajectory_sha256, some.trajectory_sha256);
}

std::string followed(const std::string& law, const std::string& more, const std::string& sensors = "") {
  return "path: {line: {from: [0], to: [0.5]}, profile: cycloidal, duration: 1 s}\n"
         "controller: {law: " +
         law + ", kp: [400], kv: [40]" + more + "}\nplant: {sensors: {" + sensors + "}}\n";
}

// The rigid model's M a: 4 kg, whatever hangs there.
TEST_F(Measured, NeedNotBeWhatAControllerKnows) {
  const Experiment experiment = load(followed("computed_torque", ", scene: rigid.yaml", "free: []"));
  EXPECT_THAT(model_coordinates(experiment), ElementsAre(0));
  std::array<double, 1> tau{};
  const std::vector<double> row{0.1, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  make_controller(experiment).torque({std::array{0.1}, std::array{0.0}}, reference_in(row, 1), tau);
  EXPECT_NEAR(tau[0], 8, 1e-14);
  const Measures measures = simulated(experiment);
  EXPECT_FALSE(measures.diverged_at);
  EXPECT_LT(measures.max_position_error, 0.05);
}

class BadMeasured : public Measured, public testing::WithParamInterface<BadInput> {};

TEST_P(BadMeasured, IsRefused) {
  const auto error = input_error([&] { load(GetParam().text); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(error->message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadMeasured,
    testing::Values(
        BadInput{"NoSuch", fed_back("1, 0, 0, 1, 0, 0", "free: [secund]"), "undefined_symbol",
                 "'secund' is no free coordinate of the scene; motors are always measured; did you mean "
                 "'second'?"},
        BadInput{"AMotor", fed_back("1, 0, 0, 1, 0, 0", "free: [cart]"), "undefined_symbol",
                 "motors are always measured"},
        BadInput{"Twice", fed_back("1, 0, 0, 1, 0, 0", "free: [first, first]"), "doubly_defined", "'first'"},
        BadInput{"FedBack", fed_back("1, 2, 0, 1, 0, 0", "free: [second]"), "not_measured",
                 "the gain feeds back the free coordinate 'first', which isn't measured"},
        BadInput{"RateFedBack", fed_back("1, 0, 0, 1, 2, 0", "free: [second]"), "not_measured", "'first'"},
        BadInput{"ModelWithIt", followed("computed_torque", "", "free: [first]"), "not_measured",
                 "the law 'computed_torque' takes its model where it stands by the free coordinate 'second'"},
        BadInput{"Fault",
                 fed_back("1, 0, 0, 1, 0, 0", "free: [second]") +
                     "faults: [{at: 0.1 s, sensor: first, kind: off}]",
                 "not_measured", "a fault of the sensor of 'first', which isn't measured"},
        BadInput{"GainTooShort", fed_back("1, 0, 1, 0", ""), "wrong_size",
                 "row 1 of the gain has 4 values; expected 6"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
