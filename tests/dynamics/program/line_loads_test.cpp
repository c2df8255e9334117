// SPDX-License-Identifier: MIT
// Springs and dampers along formulas and between points, by every way that programs are traced and evaluated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "certification.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/reference.hpp"
#include "dynamics/program/trace.hpp"
#include "notation/document.hpp"
#include "tests/oracles/random_mechanism.hpp"
#include "tests/support/allocation_counter.hpp"

namespace mixloop::testing {
namespace {

std::shared_ptr<const Scene> loaded_scene(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "loaded")));
}

/// Three parallel axes, their angles affine in the motors', gravity across: all tracers know it.
constexpr const char* kPlanar = R"(
parameters: {k: 40 N/m, damp: 0.7 N s/m}
motors: [a, b, c]
coordinates: [q1, q2, q3]
constraints: {q1: a/2, q2: b - 0.5, q3: c}
transforms:
  - {from: 0, to: 1, theta: q1, a: 0.5 m}
  - {from: 1, to: 2, theta: q2, a: 0.4 m}
  - {from: 1, to: 3, theta: q3, a: 0.3 m}
bodies:
  - {frame: 1, mass: 2 kg, center_of_mass: [-0.2, 0.02, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  - {frame: 2, mass: 1 kg, center_of_mass: [-0.1, 0, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}
  - {frame: 3, mass: 1.5 kg, center_of_mass: [-0.1, 0.01, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}
loads:
  - {coordinate: q2, stiffness: 2 N m/rad, damping: 0.1 N m s/rad}
  - {along: q2 - q3/2 + sin(c), stiffness: 3 N m/rad, rest: 0.2, damping: 0.4 N m s/rad}
  - {between: [{frame: 2}, {frame: 3, point: [0.1, 0.2, 0]}], stiffness: k, rest: 0.3 m, damping: damp}
  - {between: [{frame: 0, point: [0.2, 0.9, 0]}, {frame: 3}], stiffness: 15 N/m, rest: 0}
gravity: [0, -9.81, 0]
end_effector: {frame: 2, axes: [x, y]}
)";

/// A tree of joints about and along axes of any direction: too much for harmonics.
constexpr const char* kSpatial = R"yaml(
motors: {a: rotary, b: rotary, c: linear, d: rotary}
coordinates: [q3]
constraints: {q3: "0.6*c + 0.2 m + 0.1 m/s * t"}
transforms:
  - {from: 0, to: 1, at: [0, 0.1, 0.4], rpy: [0, 0.3, 0], revolute: 2*a + 0.1, axis: [0, 1, 1]}
  - {from: 1, to: 2, at: [0.3, 0, 0.1], rpy: [90 deg, 0, 20 deg], revolute: b}
  - {from: 2, to: 3, at: [0.2, 0.1, 0], prismatic: q3, axis: x}
  - {from: 1, to: 4, rpy: [0, 70 deg, 0], revolute: d, axis: [0, -1, 0]}
bodies:
  - {frame: 1, mass: 2, center_of_mass: [0.1, 0, 0.05], inertia: {xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.001}}
  - {frame: 2, mass: 1.5, center_of_mass: [-0.2, 0.02, 0.01], inertia: {xx: 0.02, yy: 0.03, zz: 0.04}}
  - {frame: 3, mass: 0.5, center_of_mass: [0, 0.1, 0], inertia: {xx: 0.01, yy: 0.012, zz: 0.013}}
  - {frame: 4, mass: 0.7, center_of_mass: [0, 0, 0.1], inertia: {xx: 0.01, yy: 0.012, zz: 0.013}}
loads:
  - {along: "q3 * cos(a) + 0.3 m * sin(b - t / 1 s)", stiffness: 30 N/m, rest: 5 cm, damping: 2 N s/m}
  - {between: [{frame: 3, point: [0.1, 0, 0.2]}, {frame: 4, point: [0, 0.3, 0.1]}], stiffness: 50, rest: 0.2, damping: 3}
  - {between: [{frame: 0, point: [1, 0, 0]}, {frame: 3}], rest: 0, stiffness: 8, damping: 0.5}
gravity: [0, 1, -9.81]
end_effector: {frame: 3}
)yaml";

std::vector<double> values_of(const Routine& routine, Purpose purpose, const Scene& scene,
                              const Sample& sample) {
  Evaluator evaluator(routine);
  evaluator.set_up(scene.default_parameters());
  std::vector<double> out(output_size(purpose, scene.n(), scene.n_u()));
  EXPECT_EQ(evaluator.evaluate(sample.arguments(), out), Status::ok);
  return out;
}

/// As Certification: in units in the last place of the terms' size, at most thrice as far as the procedure.
/// Of the linearisation, whose terms' size knows nothing of how loads curve, twice that.
void expect_exact(const std::shared_ptr<const Scene>& scene, std::initializer_list<Tracing> tracings,
                  std::uint64_t seed) {
  for (const Purpose purpose : kPurposes) {
    std::vector<std::pair<Sample, Oracle>> states;
    std::mt19937_64 random(seed);
    for (int k = 0; k < 4; ++k) {
      const Sample sample = random_sample(*scene, random, 2.0);
      states.emplace_back(sample, oracle(scene, scene->default_parameters(), purpose, sample));
    }
    const auto worst = [&](const Routine& routine) {
      double error = 0;
      for (const auto& [sample, truth] : states)
        error = std::max(error, error_in_ulps(truth, values_of(routine, purpose, *scene, sample)));
      return error;
    };
    const double reference = worst(*reference_routine(scene, purpose));
    for (const Tracing tracing : tracings) {
      if (tracing == Tracing::articulated && !signature(purpose).gives_psidd) continue;  // has none
      const Program program = trace(scene, purpose, tracing);
      ASSERT_FALSE(program.outputs.empty()) << name_of(purpose) << ", " << name_of(tracing);
      const double most = std::max(24.0, 3 * reference);
      EXPECT_LE(worst(Interpreter(program)), purpose == Purpose::linearisation ? 2 * most : most)
          << name_of(purpose) << ", " << name_of(tracing) << ", seed " << seed;
    }
  }
}

TEST(LineLoadPrograms, AreAsExactAsTheProcedureInEveryTracing) {
  const auto planar = loaded_scene(kPlanar);
  ASSERT_FALSE(
      trace(planar, Purpose::forward_dynamics, Tracing::articulated).outputs.empty() &&
      trace(loaded_scene(kSpatial), Purpose::forward_dynamics, Tracing::articulated).outputs.empty());
  expect_exact(planar, {Tracing::literal, Tracing::recursive, Tracing::articulated, Tracing::harmonic}, 1);
  expect_exact(loaded_scene(kSpatial), {Tracing::literal, Tracing::recursive, Tracing::articulated}, 2);
}

TEST(LineLoadPrograms, OfRandomMechanismsAreAsExactAsTheProcedure) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const oracle::RandomMechanism mechanism(seed, {.nonlinear = seed % 2 == 0, .timed = seed % 3 == 0});
    const std::string text = mechanism.scene_text();
    const auto bare = loaded_scene(text);
    std::size_t last = bare->transforms.size();
    while (!bare->transforms[last - 1].coordinate) --last;
    expect_exact(
        loaded_scene(text + fmt::format("loads:\n  - {{along: \"psi1^2 / 4 + sin(psi{})\", stiffness: 9, "
                                        "damping: 2}}\n  - {{between: [{{frame: 0}}, {{frame: '{}', "
                                        "point: [0.5, 0.25, 0]}}], stiffness: 20, rest: 0.5, damping: 1}}\n",
                                        mechanism.n(), bare->frames[last])),
        {Tracing::literal, Tracing::recursive}, seed);
  }
}

TEST(LineLoadPrograms, GiveTheSameBitsCompiledAndInterpreted) {
  for (const auto& scene : {loaded_scene(kPlanar), loaded_scene(kSpatial)}) {
    Equations::Workspace compiled(
        equations_of(scene, Evaluation::machine_code,
                     {Purpose::forward_dynamics, Purpose::energy, Purpose::inverse_dynamics}),
        scene->default_parameters());
    Equations::Workspace interpreted(
        equations_of(scene, Evaluation::interpreter,
                     {Purpose::forward_dynamics, Purpose::energy, Purpose::inverse_dynamics}),
        scene->default_parameters());
    ASSERT_EQ(compiled.equations().evaluation(), Evaluation::machine_code);
    std::mt19937_64 random(3);
    for (int k = 0; k < 50; ++k) {
      const Sample sample = random_sample(*scene, random);
      for (const Purpose purpose : {Purpose::forward_dynamics, Purpose::energy, Purpose::inverse_dynamics}) {
        std::vector<double> one = compiled.outputs(purpose), other = one;
        compiled.evaluate(purpose, sample.arguments(), one);
        interpreted.evaluate(purpose, sample.arguments(), other);
        ASSERT_EQ(one, other) << name_of(purpose);
      }
    }
  }
}

// Loads are no matter of the mass matrix.
TEST(LineLoadPrograms, LeaveTheMassMatrixAlone) {
  const auto scene = loaded_scene(kPlanar);
  auto bare = std::make_shared<Scene>(*scene);
  bare->coordinate_loads.clear(), bare->along_loads.clear(), bare->between_loads.clear();
  for (const Purpose purpose : {Purpose::mass_matrix, Purpose::mass_times})
    EXPECT_EQ(trace(scene, purpose).program.run_operations().text(),
              trace(bare, purpose).program.run_operations().text());
}

// Affine in the factor, and the bits of the scene as it stands where it is 1.
TEST(LineLoadPrograms, ScaleTheirDampingByTheFrictionFactor) {
  for (const auto& scene : {loaded_scene(kPlanar), loaded_scene(kSpatial)}) {
    const std::vector<double> parameters = scene->default_parameters();
    auto undamped = std::make_shared<Scene>(*scene);
    for (auto& load : undamped->coordinate_loads) load.damping = constant_formula(0);
    for (auto& load : undamped->along_loads) load.law.damping = constant_formula(0);
    for (auto& load : undamped->between_loads) load.law.damping = constant_formula(0);
    EXPECT_FALSE(undamped->has_friction());
    for (const Evaluation how : {Evaluation::reference, Evaluation::interpreter}) {
      const auto of = [&](const std::shared_ptr<const Scene>& one, bool factor) {
        return Equations::Workspace(equations_of(one, how, {Purpose::bias}, {.friction_factor = factor}),
                                    parameters);
      };
      Equations::Workspace plain = of(scene, false), none = of(undamped, false), scaled = of(scene, true);
      std::mt19937_64 random(4);
      for (const double factor : {1.0, 3.0, 0.0}) {
        scaled.set_parameters(parameters, factor);
        const Sample sample = random_sample(*scene, random, 2.0);
        std::vector<double> with(plain.outputs(Purpose::bias)), without = with, found = with;
        plain.evaluate(Purpose::bias, sample.arguments(), with);
        none.evaluate(Purpose::bias, sample.arguments(), without);
        scaled.evaluate(Purpose::bias, sample.arguments(), found);
        if (factor == 1) {
          EXPECT_EQ(found, with);
        }
        double size = 1;
        for (const double x : with) size += std::abs(x);
        for (std::size_t i = 0; i < with.size(); ++i)
          EXPECT_NEAR(found[i], without[i] + factor * (with[i] - without[i]), 1e-13 * size);
      }
    }
  }
}

/// A slide on whose origin a load's other end lies.
std::shared_ptr<const Scene> slide(const std::string& law) {
  return loaded_scene(
      "motors: {x: linear}\ntransforms: [{from: 0, to: slide, prismatic: x, axis: [1, 2, 0]}]\n"
      "bodies: [{frame: slide, mass: 2 kg}]\nend_effector: {frame: slide, axes: [x]}\nloads:\n"
      "  - {between: [{frame: 0}, {frame: slide}], " +
      law + "}\n");
}

std::shared_ptr<const Equations> all_equations(const std::shared_ptr<const Scene>& scene, Evaluation how) {
  return std::make_shared<const Equations>(scene, how, kPurposes, Equations::Options{});
}

constexpr Purpose kOfForces[] = {Purpose::forward_dynamics, Purpose::bias, Purpose::inverse_dynamics,
                                 Purpose::linearisation, Purpose::dynamics_and_mass_times};

TEST(LineLoadPrograms, SayThatADistanceOfZeroHasNoDirection) {
  for (const Evaluation how : {Evaluation::reference, Evaluation::interpreter, Evaluation::machine_code})
    for (const char* law : {"stiffness: 5, rest: 0.1", "stiffness: 5, rest: 0, damping: 1", "damping: 1"}) {
      const auto scene = slide(law);
      Equations::Workspace dynamics(all_equations(scene, how), std::vector<double>());
      Sample sample{.psi = {0}, .psid = {0.5}, .input = {1, 0}};
      for (const Purpose purpose : kOfForces) {
        std::vector<double> out = dynamics.outputs(purpose);
        sample.psi[0] = 0;
        EXPECT_EQ(dynamics.evaluate(purpose, sample.arguments(), out), Status::not_finite)
            << law << ", " << name_of(purpose) << ", " << name_of(how);
        sample.psi[0] = 0.25;
        EXPECT_EQ(dynamics.evaluate(purpose, sample.arguments(), out), Status::ok);
      }
      std::vector<double> M(1);
      sample.psi[0] = 0;
      EXPECT_EQ(dynamics.evaluate(Purpose::mass_matrix, sample.arguments(), M), Status::ok);
    }
}

TEST(LineLoadPrograms, DoNotAllocate) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const auto scene = loaded_scene(kSpatial);
  std::mt19937_64 random(6);
  const Sample sample = random_sample(*scene, random);
  for (const Evaluation how : {Evaluation::reference, Evaluation::interpreter}) {
    Equations::Workspace dynamics(equations_of(scene, how, {Purpose::bias, Purpose::energy}),
                                  scene->default_parameters());
    std::vector<double> h = dynamics.outputs(Purpose::bias), energy = dynamics.outputs(Purpose::energy);
    AllocationCounter counter;
    dynamics.evaluate(Purpose::bias, sample.arguments(), h);
    dynamics.evaluate(Purpose::energy, sample.arguments(), energy);
    EXPECT_EQ(counter.count(), 0U) << name_of(how);
  }
}

TEST(LineLoadPrograms, PassThroughZeroWithoutARest) {
  const auto scene = slide("stiffness: 5 N/m, rest: 0");
  for (const Evaluation how : {Evaluation::reference, Evaluation::interpreter, Evaluation::machine_code}) {
    Equations::Workspace dynamics(all_equations(scene, how), std::vector<double>());
    for (const double x : {-0.5, 0.0, 0.5}) {
      const Sample sample{.psi = {x}, .psid = {0.5}, .input = {1, 0}};
      std::vector<double> out = dynamics.outputs(Purpose::forward_dynamics);
      EXPECT_EQ(dynamics.evaluate(Purpose::forward_dynamics, sample.arguments(), out), Status::ok);
      EXPECT_NEAR(out[0], (1 - 5 * x) / 2, 1e-15) << name_of(how);
    }
  }
}

}  // namespace
}  // namespace mixloop::testing
