// SPDX-License-Identifier: MIT
#include "dynamics/equations.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "certification.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/scene/canonical.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop::testing {
namespace {

constexpr std::array kEvaluations = {Evaluation::reference, Evaluation::interpreter,
                                     Evaluation::machine_code};

std::shared_ptr<const Scene> scene_of(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "scene")));
}

std::shared_ptr<const Scene> robot() {
  return std::make_shared<const Scene>(
      load_scene(std::filesystem::path(MIXLOOP_SCENES) / "mixed_loop_robot.yaml"));
}

std::vector<double> evaluated(Equations::Workspace& dynamics, Purpose purpose, const Sample& sample) {
  std::vector<double> out = dynamics.outputs(purpose);
  EXPECT_EQ(dynamics.evaluate(purpose, sample.arguments(), out), Status::ok);
  return out;
}

/// Forward dynamics at seeded states with a payload of `payload` kg.
std::vector<std::vector<double>> run_of(const std::shared_ptr<const Equations>& equations, int payload) {
  Equations::Workspace dynamics(equations, std::vector{static_cast<double>(payload)});
  std::mt19937_64 random(static_cast<std::uint64_t>(payload));
  std::vector<std::vector<double>> all;
  for (int k = 0; k < 200; ++k)
    all.push_back(evaluated(dynamics, Purpose::forward_dynamics, random_sample(equations->scene(), random)));
  return all;
}

TEST(EquationsTest, ThreadsShareThemEachWithItsOwnParameters) {
  for (const Evaluation how : kEvaluations) {
    const auto equations = equations_of(robot(), how, {Purpose::forward_dynamics});
    constexpr int kThreads = 4;
    std::array<std::vector<std::vector<double>>, kThreads> together;
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; ++i)
      threads.emplace_back([&, i] { together[static_cast<std::size_t>(i)] = run_of(equations, i); });
    for (auto& thread : threads) thread.join();
    for (int i = 0; i < kThreads; ++i)
      EXPECT_EQ(together[static_cast<std::size_t>(i)], run_of(equations, i)) << name_of(how);
  }
}

TEST(EquationsTest, ACopyOfAWorkspaceHasParametersOfItsOwn) {
  for (const Evaluation how : kEvaluations) {
    Equations::Workspace one(equations_of(robot(), how, {Purpose::forward_dynamics}), std::vector{5.0});
    Equations::Workspace other = one;
    std::mt19937_64 random(1);
    const Sample sample = random_sample(one.scene(), random);
    const auto before = evaluated(one, Purpose::forward_dynamics, sample);
    other.set_parameters(std::vector{1.0});
    EXPECT_NE(evaluated(other, Purpose::forward_dynamics, sample), before);
    EXPECT_EQ(evaluated(one, Purpose::forward_dynamics, sample), before);
  }
}

TEST(EquationsTest, AnEvaluationSaysWhenItsResultIsNotFinite) {
  for (const Evaluation how : kEvaluations) {
    Equations::Workspace dynamics(equations_of(robot(), how, {Purpose::forward_dynamics}), std::vector{5.0});
    std::mt19937_64 random(1);
    Sample sample = random_sample(dynamics.scene(), random);
    sample.psid[1] = std::numeric_limits<double>::infinity();
    std::vector<double> out(3);
    const Status status = dynamics.evaluate(Purpose::forward_dynamics, sample.arguments(), out);
    EXPECT_EQ(name_of(status), "not_finite") << name_of(how);
    EXPECT_NE(sentence_of(status), "");
  }
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(values.size(), expected.size()) << what;
  double scale = 0;
  for (const double x : expected) scale = std::max(scale, std::abs(x));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], expected[i], tolerance * scale) << what << ", output " << i;
}

/// The scene with its last independent coordinate free.
std::shared_ptr<const Scene> with_a_free_one(const Scene& scene) {
  auto free = std::make_shared<Scene>(scene);
  free->independent.back().driven = false;
  free->canonical = canonical_text(*free);
  return free;
}

// The motors' part of what all coordinates driven give, where the last motor's torque is nothing. Both sum
// the same terms: they differ by round-off, 1e-12 of the largest output with M's condition number of 10 to
// 1000.
// A spring and a damper between two joints and at a dial: at coordinates that are no joint's, of a tree whose
// forward dynamics go by articulated bodies.
TEST(EquationsTest, LoadsMayActAtCoordinatesThatMoveNothing) {
  const auto scene = scene_of(R"(
motors: [a, b]
coordinates: [q1, q2, between, dial]
constraints: {q1: a, q2: b/3, between: q2 - 2*q1, dial: sin(a) + b/7}
transforms:
  - {from: 0, to: 1, theta: q1, a: 0.4 m, alpha: 30 deg}
  - {from: 1, to: 2, theta: q2, a: 0.3 m}
bodies:
  - {frame: 1, mass: 2 kg, center_of_mass: [-0.1, 0.02, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.02}}
  - {frame: 2, mass: 1 kg, center_of_mass: [-0.1, 0, 0.01], inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}
loads:
  - {coordinate: between, stiffness: 3 N m/rad, rest: 0.2, damping: 0.4 N m s/rad}
  - {coordinate: dial, stiffness: 5 N m/rad, damping: 0.1 N m s/rad}
  - {coordinate: q2, stiffness: 1 N m/rad}
end_effector: {frame: 2}
)");
  std::mt19937_64 random(7);
  const Sample sample = random_sample(*scene, random);
  std::vector<std::vector<double>> all;
  for (const Evaluation how : kEvaluations) {
    Equations::Workspace dynamics(equations_of(scene, how, {Purpose::forward_dynamics}),
                                  std::vector<double>());
    all.push_back(evaluated(dynamics, Purpose::forward_dynamics, sample));
  }
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    EXPECT_NEAR(all[1][i], all[0][i], 1e-12 * (1 + std::abs(all[0][i])));
    EXPECT_EQ(all[2][i], all[1][i]);
  }
}

TEST(EquationsTest, AFreeCoordinateIsADrivenOneWithoutTorque) {
  for (const auto& full : {robot(), scene_of(oracle::serial_chain(5))}) {
    const auto part = with_a_free_one(*full);
    const auto n = static_cast<std::size_t>(full->n()), n_u = n - 1;
    ASSERT_EQ(part->n_u(), static_cast<int>(n_u));
    for (const Evaluation how : kEvaluations) {
      if (how == Evaluation::machine_code && n > 3) continue;  // takes a compiler long
      const std::initializer_list<Purpose> purposes = {Purpose::forward_dynamics, Purpose::mass_times,
                                                       Purpose::inverse_dynamics, Purpose::linearisation,
                                                       Purpose::dynamics_and_mass_times};
      Equations::Workspace all(equations_of(full, how, purposes), full->default_parameters());
      Equations::Workspace some(equations_of(part, how, purposes), full->default_parameters());
      std::mt19937_64 random(2);
      for (int k = 0; k < 10; ++k) {
        Sample sample = random_sample(*full, random);
        sample.input[n - 1] = sample.input[2 * n - 1] = 0;
        Sample less = sample;
        less.input.erase(less.input.begin() + static_cast<std::ptrdiff_t>(n - 1));  // of tau and a
        const auto hold = [&](Purpose purpose, const Sample& at, std::size_t kept) {
          std::vector<double> expected = evaluated(all, purpose, sample);
          ASSERT_GE(expected.size(), kept);
          expected.resize(kept);
          expect_near(evaluated(some, purpose, at), expected, 1e-12,
                      std::string(name_of(how)) + ", " + std::string(name_of(purpose)));
        };
        hold(Purpose::forward_dynamics, less, n);
        hold(Purpose::mass_times, less, n_u);
        hold(Purpose::inverse_dynamics, sample, n);
        hold(Purpose::linearisation, less, 2 * n * n + n * n_u);
        hold(Purpose::dynamics_and_mass_times, less, n + n_u);
      }
    }
  }
}

std::shared_ptr<const Scene> without_damping(const Scene& scene) {
  auto undamped = std::make_shared<Scene>(scene);
  for (auto& load : undamped->coordinate_loads) load.damping = constant_formula(0, load.damping.dimension);
  undamped->canonical = canonical_text(*undamped);
  return undamped;
}

// All that friction has a share in is affine in it: x(f) = x(0) + f (x(1) - x(0)). Round-off as above.
TEST(EquationsTest, FrictionIsTimesItsFactorAndAsItStandsWhereThatIsOne) {
  const std::initializer_list<Purpose> purposes = {Purpose::forward_dynamics, Purpose::bias,
                                                   Purpose::inverse_dynamics, Purpose::linearisation,
                                                   Purpose::mass_matrix};
  for (const std::uint64_t seed : {2U, 6U}) {
    const oracle::RandomMechanism mechanism(seed, {.loads = true, .springs = true, .friction = true});
    const auto scene = scene_of(mechanism.scene_text());
    ASSERT_TRUE(scene->has_friction());
    const std::vector<double> parameters = scene->default_parameters();
    for (const Evaluation how : kEvaluations) {
      Equations::Workspace plain(equations_of(scene, how, purposes), parameters);
      Equations::Workspace undamped(equations_of(without_damping(*scene), how, purposes), parameters);
      Equations::Workspace scaled(equations_of(scene, how, purposes, {.friction_factor = true}), parameters);
      std::mt19937_64 random(seed);
      for (const double factor : {1.0, 3.0, 0.0, 0.25, 1.0}) {
        scaled.set_parameters(parameters, factor);
        const Sample sample = random_sample(*scene, random);
        for (const Purpose purpose : purposes) {
          const std::vector<double> found = evaluated(scaled, purpose, sample);
          std::vector<double> expected = evaluated(plain, purpose, sample);
          if (factor == 1) {
            EXPECT_EQ(found, expected) << "seed " << seed;
            continue;
          }
          const std::vector<double> none = evaluated(undamped, purpose, sample);
          for (std::size_t i = 0; i < expected.size(); ++i)
            expected[i] = none[i] + factor * (expected[i] - none[i]);
          expect_near(found, expected, 1e-11,
                      std::string(name_of(how)) + ", " + std::string(name_of(purpose)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace mixloop::testing
