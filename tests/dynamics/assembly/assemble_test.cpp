// SPDX-License-Identifier: MIT
// How closures are put together: which way, which rows, which blocks.
#include "dynamics/assembly/assemble.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dynamics/scene/read_scene.hpp"
#include "tests/dynamics/assembly/closed_scenes.hpp"

namespace mixloop {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double home_of(const Scene& scene, const std::string& name) {
  for (const auto& coordinate : scene.coordinates)
    if (coordinate.name == name) return coordinate.home;
  return std::nan("");
}

/// The rocker's angle from the ground of four_bar at a crank angle, by the cosine rule.
double rocker(double crank, double side) {
  const double x = 1 - 0.3 * std::cos(crank), y = -0.3 * std::sin(crank), d = std::hypot(x, y);
  // From the rocker's pivot to the crank's tip; the coupler's joint is 0.8 from one and 0.9 from the other.
  const double at = std::atan2(-y, -x), inner = std::acos((0.64 + d * d - 0.81) / (2 * 0.8 * d));
  return at + side * inner;
}

TEST(Assemble, FindsThePoseThatTheCosineRuleGives) {
  const Scene scene = loaded(four_bar());
  EXPECT_NEAR(std::remainder(home_of(scene, "q3") - rocker(60 * kDegree, -1), 2 * std::numbers::pi), 0,
              1e-14);
  ASSERT_EQ(scene.blocks.size(), 1u);
  EXPECT_EQ(scene.blocks[0].unknowns, (std::vector{1, 2}));
  EXPECT_FALSE(scene.blocks[0].by_newton);
  EXPECT_TRUE(scene.redundant_rows.empty()) << "the row across the plane says nothing and is dropped";
}

TEST(Assemble, TakesTheBranchThatIsNearestToTheGuess) {
  const Scene scene = loaded(four_bar("crank: 60 deg, q2: -130 deg, q3: 220 deg"));
  EXPECT_NEAR(std::remainder(home_of(scene, "q3") - rocker(60 * kDegree, 1), 2 * std::numbers::pi), 0, 1e-14);
  EXPECT_NEAR(home_of(scene, "q3"), 220 * kDegree, std::numbers::pi) << "within half a turn of its guess";
}

TEST(Assemble, ShowsBothBranchesByTheirDistance) {
  const Scene scene = read_scene(parse_document(four_bar(), "scene.yaml"));
  const auto found = branches(scene, 50);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT(found[0].from_guess, found[1].from_guess);
  for (const Branch& branch : found) {
    EXPECT_LT(branch.residual, 1e-14);
    EXPECT_FALSE(branch.is_singular);
  }
}

TEST(Assemble, AParallelogramIsLinearForGood) {
  const Scene scene = loaded(kParallelogram);
  EXPECT_FALSE(scene.is_closed());
  EXPECT_EQ(scene.linear.size(), 2u);
  const Symbols symbols(scene);
  const auto at = [&](const std::string& name, double psi) {
    for (const auto& coordinate : scene.coordinates)
      if (coordinate.name == name) return evaluate<double>(coordinate.constraint, [&](int) { return psi; });
    return std::nan("");
  };
  for (double psi : {-3.0, 0.0, 0.5, 40.0}) {
    const double crank = psi / 2 + 20 * kDegree;
    EXPECT_NEAR(at("q2", psi), -crank, 1e-14);
    EXPECT_NEAR(at("q3", psi), crank, 1e-14);
  }
}

// A bar that is 1 % longer than the one across: near the linear solution, and not it.
TEST(Assemble, ANearlyLinearBlockIsNotTakenForOne) {
  const Scene scene = loaded(with(kParallelogram, "c: 0.3 m", "c: 0.303 m"));
  EXPECT_TRUE(scene.is_closed());
  EXPECT_TRUE(scene.linear.empty());
}

// What is linear for the default alone is none: the ratio of the bars is a parameter.
TEST(Assemble, LinearIsLinearForAllParameters) {
  const std::string text = with(kParallelogram, "constants: {a: 0.3 m, b: 0.9 m, c: 0.3 m}",
                                "constants: {b: 0.9 m, a: 0.3 m}\nparameters: {c: 0.3 m}");
  const Scene scene = loaded(text);
  EXPECT_TRUE(scene.linear.empty());
  EXPECT_TRUE(scene.is_closed());
}

TEST(Assemble, RowsThatFollowFromOthersAreWatchedAndNotSolved) {
  const std::string text =
      with(four_bar(), "closures:\n",
           "closures:\n  - {name: again, coincide: [{frame: rocker}, {frame: coupler}], axes: [x, y]}\n");
  const Scene scene = loaded(text);
  ASSERT_EQ(scene.blocks.size(), 1u);
  EXPECT_EQ(scene.blocks[0].unknowns.size(), 2u);
  EXPECT_EQ(scene.redundant_rows.size(), 2u);
}

TEST(Assemble, BlocksFollowOneAnother) {
  const Scene scene = loaded(kSpatialSliderCrank);
  ASSERT_EQ(scene.blocks.size(), 2u);
  EXPECT_EQ(scene.blocks[0].unknowns, (std::vector{2, 3})) << "roll and tilt by the rows y and z";
  EXPECT_TRUE(scene.blocks[0].by_newton);
  EXPECT_EQ(scene.blocks[1].unknowns, (std::vector{1})) << "then the slide";
  EXPECT_FALSE(scene.blocks[1].by_newton);
  EXPECT_EQ(scene.started, (std::vector{2, 3}));
  EXPECT_EQ(scene.start_size(), 6);
  EXPECT_NEAR(home_of(scene, "slide"), 0.2, 1e-15);
}

TEST(Assemble, LinksThatTurnAloneAreTornOff) {
  const Scene scene = loaded(kOnThreeRods);
  ASSERT_EQ(scene.blocks.size(), 1u);
  EXPECT_EQ(scene.blocks[0].unknowns, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(scene.blocks[0].cut, (std::vector{0, 1})) << "rod 1 and the platform";
  EXPECT_EQ(scene.started, (std::vector{0, 1}));
  EXPECT_EQ(scene.corrections(), 2);
  // Where something else depends on a rod's angle it isn't alone, and of the spatial linkage nothing is.
  const Scene driven = loaded(with(kOnThreeRods, "rod3]", "rod3, wheel]") + R"(constraints: {wheel: 2*rod3}
)");
  EXPECT_EQ(driven.blocks[0].cut, (std::vector{0, 1})) << "what isn't in a row doesn't count";
  EXPECT_TRUE(loaded(kSpatialSliderCrank).blocks[0].cut.empty());
}

TEST(Assemble, AngleWhoseValueCountsHasAStart) {
  const Scene free = loaded(four_bar());
  EXPECT_TRUE(free.started.empty());
  const Scene sprung = loaded(four_bar() + "loads: [{coordinate: q3, stiffness: 2 N m/rad}]\n");
  EXPECT_EQ(sprung.started, (std::vector{2}));
}

TEST(Assemble, EveryKindOfClosure) {
  // The four-bar again: the rod kept at a distance; the rocker's end kept on the coupler's end by formulas.
  const std::string by_distance =
      with(with(four_bar(), "coordinates: [q1, q2, q3]", "coordinates: [q1, q3]"),
           "  - {name: loop, coincide: [{frame: coupler}, {frame: rocker}]}",
           "  - {name: rod, distance: 0.9 m, between: [{frame: crank}, {frame: rocker}]}");
  const std::string one_rod =
      with(with(by_distance, "  - {from: crank, to: coupler, theta: q2, a: b}\n", ""), "q2: -40 deg, ", "");
  const std::string text = with(with(one_rod,
                                     "  - {frame: coupler, mass: 2 kg, center_of_mass: [-b/2, 0, 0], "
                                     "inertia: {xx: 0, yy: 0.05, zz: 0.05}}\n",
                                     ""),
                                "frame: coupler", "frame: rocker");
  const Scene distance = loaded(text);
  EXPECT_NEAR(std::remainder(home_of(distance, "q3") - rocker(60 * kDegree, -1), 2 * std::numbers::pi), 0,
              1e-13);
  EXPECT_NEAR(distance.closures[0].home_length, 0.9, 1e-15);
  const std::string zero = with(text, "distance: 0.9 m, between: [{frame: crank}, {frame: rocker}]",
                                "zero: \"q3 - 2*crank + 10 deg\"");
  const Scene formula = loaded(zero);
  EXPECT_EQ(formula.linear.size(), 1u);
  EXPECT_NEAR(home_of(formula, "q3"), 110 * kDegree, 1e-14);
}

TEST(Assemble, AxesAreHeldParallelAndFramesAligned) {
  const std::string tree = R"yaml(
motors: [a]
coordinates: [q1, u, v, w]
constraints: {q1: a}
transforms:
  - {from: 0, to: arm, rpy: [20 deg, 30 deg, 0], revolute: q1, axis: [0, 1, 0]}
  - {from: arm, to: yoke, at: [0.3, 0, 0], revolute: u, axis: z}
  - {from: yoke, to: fork, revolute: v, axis: y}
  - {from: fork, to: hand, revolute: w, axis: x}
closures: [CLOSURE]
bodies: [{frame: hand, mass: 1 kg, inertia: {xx: 1, yy: 1, zz: 1}}]
end_effector: {frame: hand}
home: {a: 10 deg}
)yaml";
  const Scene align = loaded(with(tree, "CLOSURE", "{align: [0, hand]}"));
  EXPECT_EQ(align.blocks.size(), 1u);
  EXPECT_EQ(align.blocks[0].unknowns.size(), 3u);
  const std::string two =
      with(with(with(tree, "u, v, w]", "u, v]"), "  - {from: fork, to: hand, revolute: w, axis: x}\n",
                "  - {from: fork, to: hand, at: [0.1, 0, 0]}\n"),
           "CLOSURE", "{parallel: [{frame: 0, axis: [1, 0, 0]}, {frame: hand, axis: x}]}");
  const Scene parallel = loaded(two);
  EXPECT_EQ(parallel.closures[0].rows(), 2);
  EXPECT_TRUE(parallel.is_closed());
}

TEST(Assemble, GuessesArePartOfTheCanonicalText) {
  const Scene one = loaded(four_bar()), other = loaded(four_bar("crank: 60 deg, q2: -130 deg, q3: 220 deg"));
  EXPECT_NE(one.canonical, other.canonical);
}

}  // namespace
}  // namespace mixloop
