// SPDX-License-Identifier: MIT
// Random mechanisms, with loads, springs, friction and constraints that depend on time, held to 113 bits on
// every route; and psi'' -> tau -> psi'' at high speed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

State random_state(const Scene& scene, double speed, std::mt19937_64& random) {
  State state{{}, uniform(random, scene.n(), speed), uniform(random, scene.n(), 5), uniform(random, 1, 1)[0]};
  for (const auto& motor : scene.motors) state.psi.push_back(uniform(random, 1, motor.linear ? 0.5 : 10)[0]);
  return state;
}

TEST(RandomScenes, AreAsExactOnEveryRouteAsTheConditionNumberAllows) {
  const std::int64_t seeds = length(5, 600), states = length(2, 10);
  Figure figure("random_scenes", "eps x scale x condition", kMostUnits, seeds * states * 8);
  double condition = 0;
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    const SharedScene scene = random_scene(static_cast<std::uint64_t>(seed));
    const auto parameters = scene->default_parameters();
    Ruler ruler(scene, parameters);
    for (const Purpose purpose : {Purpose::mass_matrix, Purpose::bias, Purpose::inverse_dynamics, Purpose::forward_dynamics}) {
      // A compiler run a scene: of these a few.
      auto ways = routes(scene, purpose, full_length() && seed % 50 == 0 && purpose == Purpose::forward_dynamics);
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      for (Route& route : ways) route.routine->set_up(parameters);
      for (std::int64_t k = 0; k < states; ++k) {
        const State state = random_state(*scene, 3, random);
        std::vector<double> out(static_cast<std::size_t>(output_size(purpose, scene->n())));
        for (Route& route : ways) {
          route.routine->evaluate(state.arguments(), out.data());
          figure.look(ruler.error(purpose, state, out), [&] {
            return fmt::format("{} {}, seed {}, {}", route.name, name_of(purpose), seed, state.text());
          });
        }
      }
    }
    condition = std::max(condition, ruler.condition());
  }
  figure.note(fmt::format("condition up to {:.2g}", condition));
}

/// |x^ - x| in units of Ruler, after x -> tau -> x^.
double round_trip(Route& inverse, Route& forward, Ruler& ruler, State state) {
  const auto n = state.psi.size();
  std::vector<double> tau(n), back(n);
  const std::vector<double> psidd = state.input;
  inverse.routine->evaluate(state.arguments(), tau.data());
  state.input = tau;
  forward.routine->evaluate(state.arguments(), back.data());
  const Sizes sizes = ruler.sizes_at(state);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i)
    sum += std::pow((back[i] - psidd[i]) * sizes.M[static_cast<Eigen::Index>(i)], 2);
  return std::sqrt(sum) / ruler.unit_of_acceleration(state, psidd, tau);
}

// tau's rounding and psi'''s add up: twice the bound of one.
TEST(RoundTrip, ForwardAfterInverseDynamicsIsTheIdentityUpToAThousandRadiansASecond) {
  const std::int64_t states = length(30, 10000);
  std::vector<SharedScene> scenes = {papers_robot(), shipped_scene("spatial_slider_crank"), shipped_scene("double_four_bar")};
  const std::int64_t seeds = length(2, 60);
  for (std::int64_t seed = 1; seed <= seeds; ++seed) scenes.push_back(random_scene(static_cast<std::uint64_t>(seed)));
  Figure figure("round_trip", "eps x scale x condition", 2 * kMostUnits, static_cast<std::int64_t>(scenes.size()) * states * 3);
  for (std::size_t which = 0; which < scenes.size(); ++which) {
    const SharedScene& scene = scenes[which];
    const auto parameters = scene->default_parameters();
    Ruler ruler(scene, parameters);
    auto inverse = routes(scene, Purpose::inverse_dynamics, which < 3), forward = routes(scene, Purpose::forward_dynamics, which < 3);
    for (auto* ways : {&inverse, &forward})
      for (Route& route : *ways) route.routine->set_up(parameters);
    std::mt19937_64 random(which + 1);
    for (std::int64_t k = 0; k < states / (which < 3 ? 1 : 10); ++k) {
      const State state = random_state(*scene, log_uniform(random, 1, 1e3), random);
      for (std::size_t i = 0; i < forward.size(); ++i)
        figure.look(round_trip(inverse[i], forward[i], ruler, state), [&] {
          return fmt::format("{}, scene {} ({}), {}", forward[i].name, which, scene->name, state.text());
        });
    }
  }
}

}  // namespace
}  // namespace mixloop::stress
