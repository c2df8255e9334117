// SPDX-License-Identifier: MIT
// Every program against the literal procedure in 113-bit floats. Errors are in units in the last place of
// the natural scale: the size of the terms that make up an output. A pruning that loses digits fails here.
#include "certification.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "dynamics/scene/load_scene.hpp"
#include "notation/document.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop::testing {
namespace {

// Angles up to 10 rad times slopes of a few carry some units of their own; the procedure itself, on
// doubles, is as far off. Programs may not be three times as far.
constexpr double kMostUlps = 24.0;

double worst_error(const std::shared_ptr<const Scene>& scene, Purpose purpose, Routine& routine, int states,
                   std::uint64_t seed) {
  const std::vector<double> parameters = scene->default_parameters();
  routine.set_up(parameters);
  std::mt19937_64 random(seed);
  std::vector<double> out(static_cast<std::size_t>(output_size(purpose, scene->n())));
  double worst = 0.0;
  for (int k = 0; k < states; ++k) {
    const Sample sample = random_sample(*scene, random);
    routine.evaluate(sample.arguments(), out.data());
    worst = std::max(worst, error_in_ulps(oracle(scene, parameters, purpose, sample), out));
  }
  return worst;
}

void certify(const std::shared_ptr<const Scene>& scene, const std::string& name, int states, std::uint64_t seed) {
  for (Purpose purpose : kPurposes) {
    const double reference = worst_error(scene, purpose, *reference_routine(scene, purpose), states, seed);
    for (Tracing tracing : {Tracing::literal, Tracing::recursive, Tracing::harmonic}) {
      Program program = trace(scene, purpose, tracing);
      if (program.outputs.empty()) continue;
      Interpreter interpreter(program);
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
    certify(std::make_shared<const Scene>(load_scene(entry.path())), entry.path().stem().string(), 10, 1);
  }
}

TEST(Certification, RandomMechanismsAreAsExactAsTheProcedure) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const oracle::MechanismKind kind{.nonlinear = seed % 3 == 0, .timed = seed % 4 == 0, .loads = seed % 2 == 0,
                                     .springs = seed % 2 == 0, .friction = seed % 4 == 2};
    const oracle::RandomMechanism mechanism(seed, kind);
    const auto scene = std::make_shared<const Scene>(load_scene(parse_document(mechanism.scene_text(), "random")));
    certify(scene, fmt::format("random {}", seed), 2, seed);
  }
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
