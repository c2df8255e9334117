// SPDX-License-Identifier: MIT
// A program against libmixloop's headers alone. What it computes is what the commands compute.
#include <gmock/gmock.h>

#include <cmath>

#include <mixloop/mixloop.hpp>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kTwoRods = R"(
parameters: {tip: 1 kg}
motors: [shoulder, elbow]
coordinates: [q1, q2]
constraints: {q1: shoulder, q2: elbow}
transforms:
  - {from: 0, to: upper, theta: q1, a: 1 m}
  - {from: upper, to: lower, theta: q2, a: 1 m}
bodies:
  - {frame: upper, mass: 1 kg}
  - {frame: lower, mass: tip}
gravity: [0, -10 m/s^2, 0]
end_effector: {frame: lower, axes: [x, y]}
)";

std::vector<double> evaluated(Equations& equations, Purpose purpose, const State& at,
                              std::span<const double> input = {}) {
  std::vector<double> out(equations.output_size(purpose));
  EXPECT_EQ(equations.evaluate(purpose, at, input, out), Status::ok);
  return out;
}

template <class Call>
Error error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {"", {}, ""};
}

// Stretched out, the far mass has arms of 2 m and 1 m.
TEST(Library, TwoRodsByHand) {
  const Scene scene = Scene::parse(kTwoRods);
  EXPECT_THAT(scene.independent(), ElementsAre("shoulder", "elbow"));
  Equations equations(scene, {Purpose::mass_matrix, Purpose::bias, Purpose::energy}, Evaluation::interpreter);
  const double stretched[] = {0, 0}, turning[] = {1, 0};
  EXPECT_THAT(evaluated(equations, Purpose::mass_matrix, {stretched, {}}), ElementsAre(5, 2, 2, 1));
  EXPECT_THAT(evaluated(equations, Purpose::bias, {stretched, {}}), ElementsAre(30, 10));
  EXPECT_EQ(evaluated(equations, Purpose::energy, {stretched, turning})[0], 2.5);

  Equations heavy = equations;
  heavy.set_parameters(std::vector<double>{3});
  EXPECT_THAT(evaluated(heavy, Purpose::mass_matrix, {stretched, {}}), ElementsAre(13, 6, 6, 3));
  EXPECT_THAT(evaluated(equations, Purpose::mass_matrix, {stretched, {}}), ElementsAre(5, 2, 2, 1))
      << "a copy is another's";
}

TEST(Library, HasTheBitsOfMixloopDynamics) {
  Command command({bin("mixloop"), "dynamics", robot(), "--psi", "1,2,3", "--psid", "0.1,0.2,0.3", "--tau",
                   "1,-2,0.5", "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const auto json = command.json();
  Equations equations(Scene::load(robot()),
                      {Purpose::forward_dynamics, Purpose::mass_matrix, Purpose::bias, Purpose::end_effector},
                      Evaluation::reference);
  const double psi[] = {1, 2, 3}, psid[] = {0.1, 0.2, 0.3}, tau[] = {1, -2, 0.5};
  const auto psidd = evaluated(equations, Purpose::forward_dynamics, {psi, psid}, tau);
  EXPECT_EQ(psidd, json.at("psidd").get<std::vector<double>>());
  EXPECT_EQ(evaluated(equations, Purpose::bias, {psi, psid}), json.at("bias").get<std::vector<double>>());
  std::vector<double> mass;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) mass.push_back(json.at("mass_matrix").at(i).at(j).get<double>());
  EXPECT_EQ(evaluated(equations, Purpose::mass_matrix, {psi, psid}), mass);
  const auto hand = evaluated(equations, Purpose::end_effector, {psi, psid}, psidd);
  EXPECT_EQ(std::vector<double>(hand.begin(), hand.begin() + 3),
            json.at("end_effector").at("position").get<std::vector<double>>());
}

// 19 states fill lanes and leave some over, whether the processor has 4 or 8.
TEST(Library, ManyStatesHaveTheBitsOfOneAfterTheOther) {
  const Purpose purposes[] = {Purpose::forward_dynamics, Purpose::inverse_dynamics, Purpose::mass_matrix};
  for (const Evaluation how : {Evaluation::machine_code, Evaluation::interpreter}) {
    Equations equations(Scene::load(robot()), {std::begin(purposes), std::end(purposes)}, how);
    equations.set_parameters(std::vector<double>{3});
    for (const Purpose purpose : purposes) {
      const std::size_t states = 19, takes = equations.input_size(purpose),
                        gives = equations.output_size(purpose);
      std::vector<double> psi, psid, input;
      for (std::size_t i = 0; i < 3 * states; ++i) {
        psi.push_back(0.37 * static_cast<double>(i % 11) - 1);
        psid.push_back(0.13 * static_cast<double>(i % 7) - 0.4);
      }
      for (std::size_t i = 0; i < takes * states; ++i) input.push_back(0.7 * static_cast<double>(i % 5) - 1);
      const std::vector<double> t(states, 0.0);
      std::vector<double> all(states * gives), one(gives);
      ASSERT_EQ(equations.evaluate_all(purpose, psi, psid, t, input, all), Status::ok);
      for (std::size_t k = 0; k < states; ++k) {
        const auto row = [k](const std::vector<double>& values, std::size_t size) {
          return std::span(values).subspan(k * size, size);
        };
        ASSERT_EQ(equations.evaluate(purpose, {row(psi, 3), row(psid, 3)}, row(input, takes), one),
                  Status::ok);
        ASSERT_THAT(row(all, gives), testing::ElementsAreArray(one)) << "state " << k;
      }
    }
  }
}

/// A crank, a coupler and a rocker, in closed form; with a rod in space instead, by corrections.
constexpr const char* kFourBar = R"yaml(
motors: [crank]
coordinates: [q2, q3]
transforms:
  - {from: 0, to: crank, theta: crank, a: 0.3 m}
  - {from: crank, to: coupler, theta: q2, a: 0.9 m}
  - {from: 0, to: pivot, a: 1 m}
  - {from: pivot, to: rocker, theta: q3, a: 0.8 m}
closures: [{coincide: [{frame: coupler}, {frame: rocker}], axes: [x, y]}]
bodies: [{frame: coupler, mass: 1 kg, inertia: {xx: 0, yy: 0.1, zz: 0.1}}]
home: {crank: 60 deg, q2: -20 deg, q3: 100 deg}
)yaml";

TEST(Library, EvaluatesWhereChainsClose) {
  for (const Evaluation how : {Evaluation::machine_code, Evaluation::interpreter, Evaluation::reference}) {
    Equations equations(Scene::parse(kFourBar, "four_bar.yaml"), {Purpose::mass_matrix}, how);
    std::vector<double> psi, all(40), one(1);
    for (int k = 0; k < 40; ++k) psi.push_back(1.1 + 0.02 * k);
    const std::vector<double> t(40, 0.0);
    ASSERT_EQ(equations.evaluate_all(Purpose::mass_matrix, psi, {}, t, {}, all), Status::ok);
    for (std::size_t k = 0; k < 40; ++k) {
      ASSERT_EQ(equations.evaluate(Purpose::mass_matrix, {std::span(psi).subspan(k, 1), {}}, {}, one),
                Status::ok);
      EXPECT_NEAR(all[k], one[0], 1e-14 * one[0]);
    }
  }
}

TEST(Library, SimulatesWithTheBytesOfTheCommandByEveryRoute) {
  Command command({bin("mixloop"), "simulate", experiment("paper"), "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const std::string bytes = command.json().at("trajectory_sha256");
  const Experiment paper = Experiment::load(experiment("paper"));
  const Result result = simulate(paper);
  EXPECT_EQ(result.trajectory_sha256, bytes);
  EXPECT_EQ(result.verdict, "held");
  EXPECT_EQ(result.max_position_error, command.json().at("max_position_error").get<double>());

  Controller controller(paper);
  const auto law = [&](const State& now, const Reference& desired, std::span<double> tau) {
    controller.torque(now, desired, tau);
  };
  EXPECT_EQ(simulate(paper, law).trajectory_sha256, bytes);

  const Plan plan(paper);
  Plant plant(paper, plan);
  std::vector<double> tau(3), psi, applied;
  const auto append = [](std::vector<double>& to, std::span<const double> row) {
    to.insert(to.end(), row.begin(), row.end());
  };
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    append(psi, plant.state().psi);
    controller.torque(plant.measured(), plan.at(k), tau);
    append(applied, tau);
    plant.advance(tau);
  }
  EXPECT_EQ(psi, result.psi);
  EXPECT_EQ(applied, result.tau);
}

TEST(Library, ACopyOfAPlantGoesOnWithTheSameBytes) {
  const Experiment encoder = Experiment::load(experiment("encoder"));
  const Plan plan(encoder);
  Plant plant(encoder, plan);
  const double push[] = {0.3, -0.2, 0.1}, pull[] = {-0.1, 0.4, 0};
  for (int k = 0; k < 50; ++k) plant.advance(push);
  Plant copy = plant;
  for (Plant* one : {&plant, &copy})
    for (int k = 0; k < 50; ++k) one->measured(), one->advance(pull);
  const State state = plant.measured(), other = copy.measured();
  EXPECT_THAT(state.psi, testing::ElementsAreArray(other.psi));
  EXPECT_THAT(state.psid, testing::ElementsAreArray(other.psid));
  EXPECT_THAT(plant.state().psi, testing::ElementsAreArray(copy.state().psi));
}

TEST(Library, ErrorsHaveCodeAndPlace) {
  std::string text = kTwoRods;
  text.replace(text.find("mass: tip"), 9, "weight: 3");
  const Error unknown = error_of([&] { Scene::parse(text, "rods.yaml"); });
  EXPECT_EQ(unknown.code(), "unknown_key");
  EXPECT_EQ(unknown.place().file, "rods.yaml");
  EXPECT_EQ(unknown.place().line, 11);
  EXPECT_THAT(unknown.what(), HasSubstr("rods.yaml:11:20: "));
  EXPECT_EQ(unknown.what(), "rods.yaml:11:20: " + unknown.message());

  Equations equations(Scene::parse(kTwoRods), {Purpose::bias}, Evaluation::interpreter);
  const double psi[] = {0, 0};
  double out[4];
  EXPECT_EQ(error_of([&] {
              equations.evaluate(Purpose::mass_matrix, {psi, {}}, {}, out);
            }).code(),
            "not_asked_for");
  EXPECT_THAT(error_of([&] {
                equations.evaluate(Purpose::bias, {psi, {}}, {}, out);
              }).what(),
              HasSubstr("out has 4 numbers; expected 2"));
  EXPECT_EQ(error_of([&] { Plan(Experiment::load(experiment("paper"), {"path.line.to=[9, 0, 0]"})); }).code(),
            "unreachable");
  EXPECT_EQ(error_of([&] {
              const Experiment continuous = Experiment::load(experiment("paper_continuous"));
              Plant(continuous, Plan(continuous));
            }).code(),
            "out_of_range");
}

TEST(Library, MovesWithoutAPathAndWithoutAnEndEffector) {
  const ScratchFolder folder;
  const std::string scene(kTwoRods);
  folder.write("rods.yaml", scene.substr(0, scene.find("end_effector")));
  const Experiment free = Experiment::parse(
      "scene: rods.yaml\nduration: 2 s\ncontroller: {law: torque, torque: [0, 0]}\n"
      "plant: {integrator: gauss8, initial: [1, 0.5], initial_rates: [0, 2]}\n",
      folder.file("free.yaml"));
  const Plan plan(free);
  EXPECT_EQ(plan.ticks(), 2000);
  EXPECT_THAT(plan.at(7).psi, ElementsAre(1, 0.5));
  EXPECT_TRUE(std::isnan(plan.at(7).position[0]));

  const Result by_law = simulate(free);
  const Result by_own = simulate(free, [](const State&, const Reference& desired, std::span<double> tau) {
    EXPECT_EQ(desired.psid[0], 0);
    tau[0] = tau[1] = 0;
  });
  EXPECT_EQ(by_law.trajectory_sha256, by_own.trajectory_sha256);
  EXPECT_TRUE(std::isnan(by_law.max_position_error));
  ASSERT_TRUE(by_law.energy_drift);
  EXPECT_LT(*by_law.energy_drift, 1e-12);

  Plant plant(free, plan);
  EXPECT_THAT(plant.state().psid, ElementsAre(0, 2));
  Controller controller(free);
  double tau[2] = {1, 1};
  controller.torque(plant.measured(), plan.at(0), tau);
  EXPECT_THAT(tau, ElementsAre(0, 0));
}

TEST(Library, WhatALawThrowsComesThrough) {
  const auto law = [](const State&, const Reference&, std::span<double>) { throw std::domain_error("mine"); };
  EXPECT_THROW(simulate(Experiment::load(experiment("paper")), law), std::domain_error);
}

TEST(Library, ASingularPoseIsAStatusAndNoException) {
  Equations equations(Scene::parse(kTwoRods), {Purpose::forward_dynamics}, Evaluation::interpreter);
  equations.set_parameters(std::vector<double>{0});
  const double psi[] = {0, 0};
  double out[2];
  EXPECT_EQ(equations.evaluate(Purpose::forward_dynamics, {psi, {}}, {}, out), Status::not_finite);
}

}  // namespace
}  // namespace mixloop
