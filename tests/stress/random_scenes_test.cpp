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
  for (const auto& psi : scene.independent) state.psi.push_back(uniform(random, 1, psi.linear ? 0.5 : 10)[0]);
  return state;
}

TEST(RandomScenes, AreAsExactOnEveryRouteAsTheConditionNumberAllows) {
  const std::int64_t seeds = length(5, 100), states = length(2, 10);
  Figure figure("random_scenes", "eps x scale x condition", kMostUnits, seeds * states * 8);
  double condition = 0;
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    const SharedScene scene = random_scene(static_cast<std::uint64_t>(seed));
    const auto parameters = scene->default_parameters();
    Ruler ruler(scene, parameters);
    for (const Purpose purpose :
         {Purpose::mass_matrix, Purpose::bias, Purpose::inverse_dynamics, Purpose::forward_dynamics}) {
      // A compiler run a scene: of these a few.
      auto ways =
          routes(scene, purpose, full_length() && seed % 50 == 0 && purpose == Purpose::forward_dynamics);
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      for (Route& route : ways) route.evaluator.set_up(parameters);
      for (std::int64_t k = 0; k < states; ++k) {
        const State state = random_state(*scene, 3, random);
        std::vector<double> out(output_size(purpose, scene->n(), scene->n_u()));
        for (Route& route : ways) {
          route.evaluator.evaluate(state.arguments(), out);
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

/// Both ways round, in units of Ruler.
struct RoundTrips {
  double acceleration = 0;  ///< psi'' -> tau -> psi''
  double torque = 0;        ///< and on to tau: what solving leaves over, which no condition number excuses
};

RoundTrips round_trips(Route& inverse, Route& forward, Ruler& ruler, State state) {
  const auto n = state.psi.size();
  std::vector<double> tau(n), back(n), tau_back(n);
  const std::vector<double> psidd = state.input;
  inverse.evaluator.evaluate(state.arguments(), tau);
  state.input = tau;
  forward.evaluator.evaluate(state.arguments(), back);
  state.input = back;
  inverse.evaluator.evaluate(state.arguments(), tau_back);
  const Sizes sizes = ruler.sizes_at(state);
  const auto M = [&](std::size_t i) { return sizes.M[static_cast<Eigen::Index>(i)]; };
  RoundTrips trips;
  double moved = 0;
  for (std::size_t i = 0; i < n; ++i) moved += M(i) * std::abs(back[i]);
  for (std::size_t i = 0; i < n; ++i) {
    trips.acceleration = std::hypot(trips.acceleration, (back[i] - psidd[i]) * M(i));
    const double size = M(i) * moved + sizes.h[static_cast<Eigen::Index>(i)] + std::abs(tau[i]);
    trips.torque = std::max(trips.torque, std::abs(tau_back[i] - tau[i]) / (ruler.unit(sizes) * size));
  }
  trips.acceleration /= ruler.unit_of_acceleration(state, psidd, tau);
  return trips;
}

// Two errors add up: twice the bound of one.
constexpr double kMostOfTrip = 2 * kMostUnits;

void hold_trips(Figure& acceleration, Figure& torque, std::size_t which, std::int64_t states) {
  static const char* const kShipped[] = {"mixed_loop_robot", "spatial_slider_crank", "double_four_bar"};
  const SharedScene scene = which < 3 ? shipped_scene(kShipped[which]) : random_scene(which);
  const auto parameters = scene->default_parameters();
  Ruler ruler(scene, parameters);
  auto inverse = routes(scene, Purpose::inverse_dynamics, which < 3),
       forward = routes(scene, Purpose::forward_dynamics, which < 3);
  for (auto* ways : {&inverse, &forward})
    for (Route& route : *ways) route.evaluator.set_up(parameters);
  std::mt19937_64 random(which + 1);
  for (std::int64_t k = 0; k < states; ++k) {
    const State state = random_state(*scene, log_uniform(random, 1, 1e3), random);
    for (std::size_t i = 0; i < forward.size(); ++i) {
      const RoundTrips trips = round_trips(inverse[i], forward[i], ruler, state);
      const auto where = [&] {
        return fmt::format("{}, scene {} ({}), {}", forward[i].name, which, scene->name, state.text());
      };
      acceleration.look(trips.acceleration, where);
      torque.look(trips.torque, where);
    }
  }
}

TEST(RoundTrip, ForwardAndInverseDynamicsUndoEachOtherUpToAThousandRadiansASecond) {
  const std::size_t scenes = static_cast<std::size_t>(length(5, 30));
  const std::int64_t states = length(30, 2000);
  const auto planned = 3 * 3 * states + static_cast<std::int64_t>(scenes - 3) * 2 * (states / 10);
  Figure acceleration("round_trip", "eps x scale x condition", kMostOfTrip, planned);
  Figure torque("round_trip_torque", "eps x scale", kMostOfTrip, planned);
  for (std::size_t which = 0; which < scenes; ++which)
    hold_trips(acceleration, torque, which, which < 3 ? states : states / 10);
}

}  // namespace
}  // namespace mixloop::stress
