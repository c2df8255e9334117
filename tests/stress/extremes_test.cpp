// SPDX-License-Identifier: MIT
// Masses, lengths, gear ratios and payloads over many orders of magnitude, against the procedure in 113 bits.
// Where M is nearly singular its condition number says how much is lost; nothing beyond it may be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "loop/experiment.hpp"
#include "tests/stress/figure.hpp"
#include "tests/stress/routes.hpp"
#include "tests/stress/scenes.hpp"

namespace mixloop::stress {
namespace {

constexpr Purpose kHeld[] = {Purpose::mass_matrix, Purpose::bias, Purpose::inverse_dynamics,
                             Purpose::forward_dynamics};

/// Sets some of the robot's parameters; the rest keeps the paper's values.
class Draw {
 public:
  Draw(const Scene& scene, std::uint64_t seed)
      : random(seed), values(scene.default_parameters()), scene_(scene) {}
  void set(const std::string& name, double value) { values[parameter_index(scene_, name)] = value; }
  double operator[](const std::string& name) const { return values[parameter_index(scene_, name)]; }
  /// Log-uniform; one time in four at an end.
  double over(double low, double high) {
    const auto side = random() % 8;
    return side == 0 ? low : side == 1 ? high : log_uniform(random, low, high);
  }

  std::mt19937_64 random;
  std::vector<double> values;

 private:
  const Scene& scene_;
};

/// Joint angles of +-pi and rates of 3 rad/s behind these ratios; torques and accelerations as the robot has.
State state_behind(const std::vector<double>& ratios, Ruler& ruler, std::mt19937_64& random) {
  State state{uniform(random, 3, std::numbers::pi), uniform(random, 3, 3), uniform(random, 3, 1)};
  for (std::size_t i = 0; i < 3; ++i) state.psi[i] *= ratios[i], state.psid[i] *= ratios[i];
  const Sizes sizes = ruler.sizes_at(state);
  for (std::size_t i = 0; i < 3; ++i) state.input[i] *= sizes.h[static_cast<Eigen::Index>(i)];
  return state;
}

std::vector<double> motor_ratios(const Draw& draw) {
  return {draw["r1"], draw["r2"] * draw["r3"], draw["r4"] * draw["r5"]};
}

/// One state on every route of a purpose.
void look(Figure& figure, Ruler& ruler, Purpose purpose, std::vector<Route>& ways, const Draw& draw,
          const State& state, std::int64_t seed) {
  for (Route& route : ways) {
    std::vector<double> out(output_size(purpose, 3, 3));
    route.evaluator.set_up(draw.values);
    route.evaluator.evaluate(state.arguments(), out);
    figure.look(ruler.error(purpose, state, out), [&] {
      return fmt::format("{} {}, seed {}, {}; {}", route.name, name_of(purpose), seed,
                         text_of("parameters", draw.values), state.text());
    });
  }
}

/// All routes at this many draws; the figure is the worst error in units of Ruler.
void hold(const std::string& name, std::int64_t draws, const std::function<void(Draw&)>& draw_some) {
  const SharedScene scene = robot_of_parameters();
  std::vector<std::pair<Purpose, std::vector<Route>>> all;
  for (const Purpose purpose : kHeld) all.emplace_back(purpose, routes(scene, purpose, true));
  double worst_condition = 0;
  Figure figure(name, "eps x scale x condition", kMostUnits, draws * 12);
  for (std::int64_t seed = 1; seed <= draws; ++seed) {
    Draw draw(*scene, static_cast<std::uint64_t>(seed));
    draw_some(draw);
    Ruler ruler(scene, draw.values);
    const State torques = state_behind(motor_ratios(draw), ruler, draw.random);
    // Accelerations of the size that such torques bring: tau_i / M_i^2.
    State accelerations = torques;
    const Sizes sizes = ruler.sizes_at(torques);
    for (std::size_t i = 0; i < 3; ++i)
      accelerations.input[i] /= std::pow(sizes.M[static_cast<Eigen::Index>(i)], 2);
    for (auto& [purpose, ways] : all)
      look(figure, ruler, purpose, ways, draw, purpose == Purpose::inverse_dynamics ? accelerations : torques,
           seed);
    worst_condition = std::max(worst_condition, ruler.condition());
  }
  figure.note(fmt::format("condition up to {:.2g}", worst_condition));
}

const char* const kScales[] = {"s1", "s2", "s3", "s4", "s5", "s6"};
const char* const kLengths[] = {"L1", "L2", "L3", "L4", "L5", "L6"};
const char* const kRatios[] = {"r1", "r2", "r3", "r4", "r5", "r6"};

TEST(MassRatios, OfAMillionthToAMillionLoseNoMoreThanTheConditionNumberSays) {
  hold("mass_ratios", length(25, 2000), [](Draw& draw) {
    for (const char* name : kScales) draw.set(name, draw.over(1e-6, 1e6));
    draw.set("payload", 5 * draw.over(1e-6, 1e6));
  });
}

TEST(LinkLengths, OfAMillimetreToAKilometreLoseNoMoreThanTheConditionNumberSays) {
  hold("link_lengths", length(25, 2000), [](Draw& draw) {
    for (const char* name : kLengths) draw.set(name, draw.over(1e-3, 1e3));
  });
}

TEST(GearRatios, OfOneToTenThousandLoseNoMoreThanTheConditionNumberSays) {
  hold("gear_ratios", length(25, 2000), [](Draw& draw) {
    for (const char* name : kRatios) draw.set(name, draw.over(1, 1e4));
  });
}

TEST(Payload, OfNothingToATonneLosesNoMoreThanTheConditionNumberSays) {
  hold("payload", length(25, 2000),
       [](Draw& draw) { draw.set("payload", draw.random() % 8 == 0 ? 0 : draw.over(1e-6, 1e3)); });
}

// The same numbers folded into the scene take other tracers' ways: whole ratios are harmonics.
TEST(FoldedRatios, LoseNoMoreThanTheConditionNumberSays) {
  const std::int64_t scenes = length(8, 20), states = length(4, 100);
  Figure figure("folded_ratios", "eps x scale x condition", kMostUnits, scenes * states * 3);
  for (std::int64_t seed = 1; seed <= scenes; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::vector<Override> overrides;
    std::vector<double> r;
    for (const char* name : kRatios) {
      r.push_back(std::round(log_uniform(random, 1, 1e4)));
      overrides.push_back({fmt::format("constants.{}", name), fmt::format("{}", r.back())});
    }
    const auto scene =
        std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml", overrides));
    const auto parameters = scene->default_parameters();
    auto ways = routes(scene, Purpose::forward_dynamics, seed == 1 || full_length());
    Ruler ruler(scene, parameters);
    for (Route& route : ways) route.evaluator.set_up(parameters);
    for (std::int64_t k = 0; k < states; ++k) {
      const State state = state_behind({r[0], r[1] * r[2], r[3] * r[4]}, ruler, random);
      for (Route& route : ways) {
        std::vector<double> out(3);
        route.evaluator.evaluate(state.arguments(), out);
        figure.look(ruler.error(Purpose::forward_dynamics, state, out), [&] {
          return fmt::format("{}, seed {}, {}; {}", route.name, seed, text_of("r1 to r6", r), state.text());
        });
      }
    }
  }
}

}  // namespace
}  // namespace mixloop::stress
