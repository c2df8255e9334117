// SPDX-License-Identifier: MIT
// Every program against the literal procedure in 113-bit floats. Errors are in units in the last place of
// the natural scale: the size of the terms that make up an output. A pruning that loses digits fails here.
#include "certification.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"
#include "tests/oracles/random_mechanism.hpp"
#include "tests/support/free_ones.hpp"

namespace mixloop::testing {
namespace {

// Angles up to 10 rad times slopes of a few carry some units of their own; the procedure itself, on
// doubles, is as far off. Programs may not be three times as far.
constexpr double kMostUlps = 24.0;

double worst_error(const std::shared_ptr<const Scene>& scene, Purpose purpose, const Routine& routine,
                   int states, std::uint64_t seed) {
  const std::vector<double> parameters = scene->default_parameters();
  Evaluator evaluator(routine);
  evaluator.set_up(parameters);
  std::mt19937_64 random(seed);
  std::vector<double> out(output_size(purpose, scene->n(), scene->n_u()));
  double worst = 0.0;
  for (int k = 0; k < states; ++k) {
    const Sample sample = random_sample(*scene, random);
    evaluator.evaluate(sample.arguments(), out);
    worst = std::max(worst, error_in_ulps(oracle(scene, parameters, purpose, sample), out));
  }
  return worst;
}

void certify(const std::shared_ptr<const Scene>& scene, const std::string& name, int states,
             std::uint64_t seed) {
  for (Purpose purpose : kPurposes) {
    const double reference = worst_error(scene, purpose, *reference_routine(scene, purpose), states, seed);
    for (Tracing tracing : {Tracing::literal, Tracing::recursive, Tracing::articulated, Tracing::harmonic}) {
      Program program = trace(scene, purpose, tracing);
      if (program.outputs.empty()) continue;
      const Interpreter interpreter(program);
      const double error = worst_error(scene, purpose, interpreter, states, seed);
      EXPECT_LE(error, std::max(kMostUlps, 3.0 * reference))
          << name << ", " << name_of(purpose) << ", " << name_of(tracing) << ", seed " << seed;
      ::testing::Test::RecordProperty(fmt::format("{}_{}_{}", name, name_of(purpose), name_of(tracing)),
                                      fmt::format("{:.2f}", error));
    }
  }
}

TEST(Certification, EveryShippedSceneIsAsExactAsTheProcedure) {
  for (const auto& entry : std::filesystem::directory_iterator(MIXLOOP_SCENES)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto scene = std::make_shared<const Scene>(load_scene(entry.path()));
    // Where chains close, samples far from home have no pose: closed_programs_test and shipped_closures_test.
    if (!scene->is_closed()) certify(scene, entry.path().stem().string(), 10, 1);
  }
}

TEST(Certification, RandomMechanismsAreAsExactAsTheProcedure) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const oracle::MechanismKind kind{.nonlinear = seed % 3 == 0,
                                     .timed = seed % 4 == 0,
                                     .loads = seed % 2 == 0,
                                     .springs = seed % 2 == 0,
                                     .friction = seed % 4 == 2};
    const oracle::RandomMechanism mechanism(seed, kind);
    const auto scene =
        std::make_shared<const Scene>(load_scene(parse_document(mechanism.scene_text(), "random")));
    certify(scene, fmt::format("random {}", seed), 2, seed);
  }
}

TEST(Certification, RandomMechanismsThatMoveFreelyAreAsExactAsTheProcedure) {
  int freed = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const oracle::RandomMechanism mechanism(seed, {.nonlinear = seed % 2 == 0, .springs = seed % 3 == 0});
    if (mechanism.n() < 2) continue;
    const int motors = 1 + static_cast<int>(seed) % (mechanism.n() - 1);
    const auto scene = std::make_shared<const Scene>(
        load_scene(parse_document(with_free_ones(mechanism.scene_text(), motors), "random")));
    ASSERT_EQ(scene->n_u(), motors);
    ASSERT_EQ(scene->n(), mechanism.n());
    certify(scene, fmt::format("free {}", seed), 2, seed);
    ++freed;
  }
  EXPECT_GE(freed, 6);
}

// Three joints that one motor turns by factors that are no fractions, and as many motors: base angles of
// which each has one motor alone, and none its own.
TEST(Certification, AsManyJointsOfOneMotorAsThereAreMotors) {
  const char* text = R"(
motors: {a: linear, b: linear, c: rotary}
coordinates: [{x: linear}, {y: linear}, q1, q2, q3]
constraints: {x: a, y: b, q1: 1.1060791015625*c, q2: 0.7071067811865476*c, q3: -0.4403686523437500*c}
transforms:
  - {from: 0, to: 1, theta: q1, a: 0.5}
  - {from: 1, to: 2, theta: q2, a: 0.4, alpha: 90 deg}
  - {from: 2, to: 3, s: 0.1 m + x}
  - {from: 0, to: 4, theta: q3, a: 0.3, alpha: 90 deg}
  - {from: 4, to: 5, s: y}
bodies:
  - {frame: 1, mass: 2, center_of_mass: [-0.2, 0.1, 0], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
  - {frame: 3, mass: 1.5, center_of_mass: [0.1, 0.02, 0.03], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
  - {frame: 5, mass: 0.7, center_of_mass: [0.2, 0.1, 0], inertia: {xx: 0.01, yy: 0.012, zz: 0.013}}
gravity: [0, -9.81, 0]
end_effector: {frame: 3}
)";
  const auto scene = std::make_shared<const Scene>(load_scene(parse_document(text, "made")));
  ASSERT_FALSE(trace(scene, Purpose::mass_matrix, Tracing::harmonic).outputs.empty());
  certify(scene, "one motor's joints", 4, 1);
}

// A tree whose coordinates are the motors', scaled and offset: articulated bodies trace it too.
constexpr const char* kTree = R"(
parameters: {load: 2 kg}
motors: {a: rotary, b: rotary, c: rotary, d: linear, e: rotary}
coordinates: [q1, q2, q3, q4, q5]
constraints: {q1: 2*a - 1 + 0.1/s*t, q2: -b/4, q3: c + 0.5, q4: 0.5*d + 0.2, q5: e}
transforms:
  - {from: 0, to: 1, theta: q1, s: 0.2, a: 0, alpha: 90 deg}
  - {from: 1, to: 2, theta: -q2 + 0.3, s: 0, a: 0.4, alpha: 30 deg}
  - {from: 2, to: mount, theta: 20 deg, s: 0.1, a: 0.1, alpha: 40 deg}
  - {from: mount, to: 3, theta: q3, s: 0.1, a: 0.3, alpha: -90 deg}
  - {from: 2, to: 4, theta: 50 deg, s: 2*q4, a: 0.1, alpha: 60 deg}
  - {from: 4, to: 5, theta: q5, s: 0, a: 0.2, alpha: 0}
bodies:
  - {frame: 1, mass: 2, center_of_mass: [0.1, 0, 0.05], inertia: {xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.001}}
  - {frame: 2, mass: 1.5, center_of_mass: [-0.2, 0.02, 0.01], inertia: {xx: 0.02, yy: 0.03, zz: 0.04, yz: 0.002}}
  - {frame: mount, mass: 0.5, center_of_mass: [0, 0.1, 0]}
  - {frame: 3, mass: load, center_of_mass: [-0.1, 0, 0], inertia: {xx: 0.01, yy: 0.012, zz: 0.013}}
  - {frame: 4, mass: 0.7, center_of_mass: [0, 0, 0.1], inertia: {xx: 0.01, yy: 0.012, zz: 0.013}}
  - {frame: 5, mass: 0.3, center_of_mass: [-0.1, 0.03, 0], inertia: {xx: 0.001, yy: 0.002, zz: 0.002}}
loads:
  - {frame: 3, point: [0.1, 0, 0], force: [1, 2 N/s * t, 0]}
gravity: [0, 1, -9.81]
end_effector: {frame: 3, point: [0, 0, 0]}
)";

TEST(Certification, ArticulatedBodiesAreAsExactOnTreesAndLongChains) {
  const auto made = [](const std::string& text) {
    return std::make_shared<const Scene>(load_scene(parse_document(text, "made")));
  };
  const auto tree = made(kTree);
  ASSERT_FALSE(trace(tree, Purpose::forward_dynamics, Tracing::articulated).outputs.empty());
  certify(tree, "tree", 4, 1);
  for (const auto& scene : {made(oracle::serial_chain(12)), made(oracle::parallelogram_chain(4))}) {
    const TracedProgram traced = trace(scene, Purpose::forward_dynamics);
    const Interpreter interpreter(traced.program);
    const double reference = worst_error(scene, Purpose::forward_dynamics,
                                         *reference_routine(scene, Purpose::forward_dynamics), 3, 1);
    EXPECT_LE(worst_error(scene, Purpose::forward_dynamics, interpreter, 3, 1),
              std::max(kMostUlps, 3.0 * reference));
  }
}

// Where links are many and motors few, the mass matrix is traced column by column.
TEST(Certification, LongChainsOfFewMotorsAreAsExactAsTheProcedure) {
  const auto coiled =
      std::make_shared<const Scene>(load_scene(parse_document(oracle::coiled_chain(80, 3), "coiled")));
  for (Purpose purpose : {Purpose::mass_matrix, Purpose::forward_dynamics, Purpose::energy}) {
    const double reference = worst_error(coiled, purpose, *reference_routine(coiled, purpose), 3, 1);
    const Interpreter interpreter(trace(coiled, purpose, Tracing::recursive));
    EXPECT_LE(worst_error(coiled, purpose, interpreter, 3, 1), std::max(kMostUlps, 3.0 * reference))
        << name_of(purpose);
  }
}

// No blow-up: from n to 2n at most four times the operations, to n = 32; articulated bodies grow in
// proportion.
TEST(Certification, OperationsGrowNoFasterThanTheSquare) {
  const auto flops = [](const std::string& text) {
    const auto scene = std::make_shared<const Scene>(load_scene(parse_document(text, "chain")));
    return static_cast<double>(trace(scene, Purpose::forward_dynamics).program.run_operations().flops());
  };
  for (int n : {4, 8, 16})
    EXPECT_LE(flops(oracle::serial_chain(2 * n)), 4.0 * flops(oracle::serial_chain(n))) << n;
  EXPECT_LE(flops(oracle::serial_chain(32)), 2.2 * flops(oracle::serial_chain(16)));
  EXPECT_LE(flops(oracle::parallelogram_chain(16)), 4.0 * flops(oracle::parallelogram_chain(8)));
}

// The numbers that the project is held to: operations of the paper's robot, payload a parameter.
TEST(Certification, ThePapersRobotTakesNoMoreOperationsThanPromised) {
  const auto robot = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  const auto count = [&](Purpose purpose) { return trace(robot, purpose).program.run_operations(); };
  const OperationCount forward = count(Purpose::forward_dynamics);
  EXPECT_LE(forward.flops(), 150u);
  EXPECT_LE(forward.sincos, 3u);
  EXPECT_LE(count(Purpose::mass_matrix).flops(), 60u);
  EXPECT_LE(count(Purpose::mass_times).flops(), 66u);
  EXPECT_LE(count(Purpose::dynamics_and_mass_times).flops(), 170u);
}

// theta'' = 3.5 g / 3 sin(theta), in three operations and a sine.
TEST(Certification, TheDoubleFourBarCollapsesToItsOneEquation) {
  const auto scene = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/double_four_bar.yaml"));
  EXPECT_LE(trace(scene, Purpose::forward_dynamics).program.run_operations().flops(), 3u);
}

}  // namespace
}  // namespace mixloop::testing
