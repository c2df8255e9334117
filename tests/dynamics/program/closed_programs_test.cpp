// SPDX-License-Identifier: MIT
// Programs of scenes whose chains close: by every way of tracing and evaluating, against the procedure on a
// wide float, which solves the closures by its own Newton's method.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "dynamics/equations.hpp"
#include "dynamics/procedure/outputs.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/trace.hpp"
#include "tests/dynamics/assembly/closed_scenes.hpp"
#include "tests/oracles/in_wide.hpp"

namespace mixloop {
namespace {

using oracle::Wide;

std::shared_ptr<const Scene> shared(const std::string& text) {
  return std::make_shared<const Scene>(loaded(text));
}

const std::string kWound =
    four_bar() + "loads: [{coordinate: q3, stiffness: 2 N m/rad, damping: 0.1 N m s/rad}]\n";
const std::string kInclined =
    with(with(with(four_bar("crank: 60 deg, q2: -70 deg, x: 1 m"), "[q1, q2, q3]", "[q1, q2, x]"),
              "{from: pivot, to: rocker, theta: q3, a: c}",
              "{from: pivot, to: rail, theta: 115 deg, alpha: 90 deg}\n  - {from: rail, to: rocker, s: x}"),
         "g: 1 m", "g: 0.2 m");
const std::string kInverted = R"yaml(
motors: [crank]
coordinates: [q1, arm, x]
constraints: {q1: crank}
transforms:
  - {from: 0, to: crank, theta: q1, a: 0.2 m}
  - {from: 0, to: pivot, a: 0.5 m}
  - {from: pivot, to: arm, theta: arm, alpha: 90 deg}
  - {from: arm, to: slider, at: [0, 0.1 m, 0], prismatic: x, axis: x}
closures:
  - {coincide: [{frame: crank}, {frame: slider}], axes: [x, y]}
bodies:
  - {frame: crank, mass: 1 kg, center_of_mass: [-0.1, 0, 0], inertia: {xx: 0, yy: 0.01, zz: 0.01}}
  - {frame: slider, mass: 0.5 kg, inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}
gravity: [0, -9.81, 0]
end_effector: {frame: slider, axes: [x]}
home: {crank: 70 deg, arm: 150 deg, x: 0.4 m}
)yaml";
const std::string kTelescope = with(
    with(with(four_bar("crank: 60 deg, q3: 80 deg"), "[q1, q2, q3]", "[q1, q3]"),
         "  - {from: crank, to: coupler, theta: q2, a: b}\n", ""),
    "{name: loop, coincide: [{frame: coupler}, {frame: rocker}]}",
    "{name: rod, distance: \"0.9 m + 5 cm * sin(t / 1 s)\", between: [{frame: crank}, {frame: rocker}]}");
const std::string kDriven = with(with(kTelescope,
                                      "  - {frame: coupler, mass: 2 kg, center_of_mass: [-b/2, 0, 0], "
                                      "inertia: {xx: 0, yy: 0.05, zz: 0.05}}\n",
                                      ""),
                                 "frame: coupler", "frame: rocker");

/// Torn: the platform slides on its rod, which turns with it by a gear. The angles of two links count, of one
/// that is cut and of one that is not.
const std::string kTorn =
    with(with(with(with(kOnThreeRods, "[rod1, turn,", "[gear, slide, turn,"),
                   "revolute: rod1}\n  - {from: B, to: platform, at: [0.6 m, 0, 0], revolute: turn}",
                   "revolute: gear}\n  - {from: B, to: slide, prismatic: slide, axis: [1, 0, 0]}\n"
                   "  - {from: slide, to: platform, revolute: turn}"),
              "rod1: -25 deg,", "slide: 0.6 m,"),
         "closures:", "constraints: {gear: \"-25 deg + 0.3*(turn + 7 deg)\"}\nclosures:") +
    "loads: [{coordinate: rod3, stiffness: 2 N m/rad}, {coordinate: turn, stiffness: 3 N m/rad}]\n";

struct Closed {
  const char* name;
  std::string text;
  bool by_newton;
};

std::ostream& operator<<(std::ostream& out, const Closed& closed) { return out << closed.name; }

class ClosedPrograms : public ::testing::TestWithParam<Closed> {
 protected:
  struct Pose {
    std::vector<double> psi, psid, input;
    double t;
  };

  /// A walk from home in small steps.
  std::vector<Pose> walk() const {
    std::vector<Pose> poses;
    const int n = scene->n();
    for (int k = 1; k <= 60; ++k) {
      Pose pose{scene->home, std::vector<double>(static_cast<std::size_t>(n), 0.8),
                std::vector<double>(static_cast<std::size_t>(3 * n), 0.4), 0.01 * k};
      for (auto& x : pose.psi) x += 0.01 * k;
      poses.push_back(std::move(pose));
    }
    return poses;
  }

  std::shared_ptr<const Scene> scene = shared(GetParam().text);
  std::vector<double> parameters = scene->default_parameters();
};

constexpr auto kAll = {
    Purpose::forward_dynamics, Purpose::mass_times,   Purpose::mass_matrix, Purpose::bias,
    Purpose::inverse_dynamics, Purpose::end_effector, Purpose::energy,      Purpose::dynamics_and_mass_times};

TEST_P(ClosedPrograms, AreTheProcedureOnAWideFloat) {
  const std::vector<Wide> wide_parameters(parameters.begin(), parameters.end());
  const auto model = make_model<Wide>(scene, std::span<const Wide>(wide_parameters));
  Workspace<Wide> wide(model);
  Equations::Workspace programs(equations_of(scene, Evaluation::interpreter, kAll), parameters);
  const auto widened = [](const std::vector<double>& x) { return std::vector<Wide>(x.begin(), x.end()); };
  for (const Pose& pose : walk()) {
    const auto psi = widened(pose.psi), psid = widened(pose.psid), input = widened(pose.input);
    for (Purpose purpose : kAll) {
      auto out = programs.outputs(purpose);
      std::vector<Wide> expected(out.size());
      ASSERT_EQ(programs.evaluate(purpose, {pose.psi, pose.psid, pose.input, pose.t}, out), Status::ok);
      put_outputs<Wide>(purpose, model, psi, psid, input, Wide(pose.t), wide, expected.data());
      double size = 0;
      for (const auto& x : expected) size = std::max(size, std::abs(static_cast<double>(x)));
      for (std::size_t i = 0; i < out.size(); ++i)
        EXPECT_NEAR(out[i], static_cast<double>(expected[i]), 2e-13 * std::max(size, 1.0))
            << name_of(purpose) << " " << i << " at t = " << pose.t;
    }
  }
}

TEST_P(ClosedPrograms, OfAllTracersAgreeAndTheirSlopesAreDifferences) {
  const auto pose = walk()[20];
  Equations::Workspace programs(
      equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics, Purpose::linearisation}),
      parameters);
  auto slopes = programs.outputs(Purpose::linearisation);
  ASSERT_EQ(programs.evaluate(Purpose::linearisation, {pose.psi, pose.psid, pose.input, pose.t}, slopes),
            Status::ok);
  const auto psidd = [&](Pose at) {
    auto out = programs.outputs(Purpose::forward_dynamics);
    EXPECT_EQ(programs.evaluate(Purpose::forward_dynamics, {at.psi, at.psid, at.input, at.t}, out),
              Status::ok);
    return out;
  };
  const auto n = static_cast<std::size_t>(scene->n());
  for (std::size_t k = 0; k < 2 * n; ++k) {
    // A fourth-order difference: to 1e-10 of the acceleration's size.
    const auto at = [&](double by) {
      Pose moved = pose;
      (k < n ? moved.psi[k] : moved.psid[k - n]) += by;
      return psidd(moved);
    };
    const double h = 2e-3;
    for (std::size_t i = 0; i < n; ++i) {
      const double slope = (8 * (at(h)[i] - at(-h)[i]) - (at(2 * h)[i] - at(-2 * h)[i])) / (12 * h);
      EXPECT_NEAR(slopes[k * n + i], slope, 1e-6 * (1 + std::abs(slope))) << k << " " << i;
    }
  }
}

TEST_P(ClosedPrograms, GiveTheSameBitsCompiledAndInterpreted) {
  // Long programs take a compiler long: of torn blocks shipped_closures_test has all purposes.
  std::vector<Purpose> purposes{Purpose::forward_dynamics};
  if (scene->started_rates() == 0) purposes = kAll;
  Equations::Workspace code(equations_of(scene, Evaluation::machine_code, purposes), parameters),
      interpreted(equations_of(scene, Evaluation::interpreter, purposes), parameters);
  if (code.equations().evaluation() != Evaluation::machine_code) GTEST_SKIP() << "no compiler";
  for (const Pose& pose : walk())
    for (Purpose purpose : purposes) {
      auto one = code.outputs(purpose), other = one;
      code.evaluate(purpose, {pose.psi, pose.psid, pose.input, pose.t}, one);
      interpreted.evaluate(purpose, {pose.psi, pose.psid, pose.input, pose.t}, other);
      EXPECT_EQ(one, other) << name_of(purpose) << " at t = " << pose.t;
    }
}

TEST_P(ClosedPrograms, KeepTheirClosuresClosed) {
  Equations::Workspace programs(equations_of(scene, Evaluation::interpreter, {Purpose::mass_matrix}),
                                parameters);
  for (const Pose& pose : walk()) {
    ASSERT_EQ(programs.closures().accept(pose.psi, pose.t), Status::ok);
    const ClosureWatch watch = programs.closures().watch();
    EXPECT_LT(watch.residual, 2e-15 * std::max(1.0, scene->size));
    EXPECT_GE(watch.conditions[watch.worst()], 1 - 1e-12);
    EXPECT_FALSE(watch.is_singular());
  }
}

TEST_P(ClosedPrograms, AreSolvedByWhatServes) {
  for (const auto& block : scene->blocks)
    EXPECT_EQ(block.by_newton, GetParam().by_newton && &block == &scene->blocks[0]);
}

TEST_P(ClosedPrograms, GoOnTheSameWayFromAnAnchorThatIsPutBack) {
  const auto equations = equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics});
  Equations::Workspace programs(equations, parameters);
  programs.hold_anchor();
  const auto poses = walk();
  for (int k = 0; k < 30; ++k)
    programs.closures().accept(poses[static_cast<std::size_t>(k)].psi, poses[static_cast<std::size_t>(k)].t);
  const std::vector<double> anchor(programs.closures().anchor().begin(), programs.closures().anchor().end());
  Equations::Workspace other(equations, parameters);
  other.hold_anchor();
  other.closures().put_back(anchor);
  auto one = programs.outputs(Purpose::forward_dynamics), two = one;
  for (int k = 30; k < 40; ++k) {
    const Pose& pose = poses[static_cast<std::size_t>(k)];
    for (auto* workspace : {&programs, &other})
      workspace->evaluate(Purpose::forward_dynamics, {pose.psi, pose.psid, pose.input, pose.t},
                          workspace == &programs ? one : two);
    EXPECT_EQ(one, two);
    programs.closures().accept(pose.psi, pose.t), other.closures().accept(pose.psi, pose.t);
  }
}

INSTANTIATE_TEST_SUITE_P(, ClosedPrograms,
                         ::testing::Values(Closed{"FourBar", four_bar(), false},
                                           Closed{"Wound", kWound, false},
                                           Closed{"Inclined", kInclined, false},
                                           Closed{"Inverted", kInverted, false},
                                           Closed{"Driven", kDriven, false}, Closed{"Torn", kTorn, true},
                                           Closed{"Spatial", kSpatialSliderCrank, true}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(ClosedProgram, OfAFourBarTakesNoMoreThanByHand) {
  const auto count = trace(shared(four_bar()), Purpose::forward_dynamics).program.run_operations();
  EXPECT_LE(count.flops(), 120u);
  EXPECT_EQ(count.sincos, 1u) << "no sine of a solved angle";
  EXPECT_EQ(count.other, 0u);
}

TEST(ClosedProgram, OfAParallelogramIsThatOfItsFormulas) {
  std::string text = kParallelogram;
  text = with(text, "closures:\n  - {coincide: [{frame: coupler}, {frame: rocker}], axes: [x, y]}\n", "");
  text = with(text, "home: {psi: 60 deg, q2: -50 deg, q3: 50 deg}", "home: {psi: 60 deg}");
  text = with(text, "psi/2 + 20 deg}", "psi/2 + 20 deg, q2: -psi/2 - 20 deg, q3: psi/2 + 20 deg}");
  for (Purpose purpose : kAll) {
    const auto closed = trace(shared(kParallelogram), purpose).program,
               formulas = trace(shared(text), purpose).program;
    EXPECT_EQ(closed.run_operations().flops(), formulas.run_operations().flops()) << name_of(purpose);
    EXPECT_EQ(closed.run_operations().sincos, formulas.run_operations().sincos) << name_of(purpose);
  }
}

// (B-4) and (B-6) from the loop of links 2, 4, 5 and 6 instead of by formulas: the same programs, with no
// operation more.
TEST(ClosedProgram, OfThePapersPantographIsThatOfItsFormulas) {
  std::ifstream file(std::string(MIXLOOP_SCENES) + "/mixed_loop_robot.yaml");
  const std::string formulas{std::istreambuf_iterator<char>(file), {}};
  std::string closed = with(formulas, "  q4: pi - q2 + beta + q3                              # (B-4)\n", "");
  closed = with(closed, "  q6: q2 - beta - q3                                   # (B-6)\n", "");
  closed = with(closed, "home: {psi1: 0 deg, psi2: -960 deg, psi3: 992 deg}",
                "home: {psi1: 0 deg, psi2: -960 deg, psi3: 992 deg, q4: 110 deg, q6: -60 deg}\n"
                "closures:\n  - {coincide: [{frame: 6}, {frame: 2, point: [L5*cos(beta) - L2, -L5*sin(beta), "
                "0]}], axes: [x, y]}");
  const auto one = shared(formulas), other = shared(closed);
  EXPECT_EQ(other->linear.size(), 2u);
  EXPECT_FALSE(other->is_closed());
  for (Purpose purpose : kPurposes) {
    const auto by_formulas = trace(one, purpose).program.run_operations(),
               by_closure = trace(other, purpose).program.run_operations();
    EXPECT_LE(by_closure.flops(), by_formulas.flops()) << name_of(purpose);
    EXPECT_EQ(by_closure.sincos, by_formulas.sincos) << name_of(purpose);
  }
  for (std::size_t j = 0; j < one->coordinates.size(); ++j)
    for (const std::vector<double>& psi : {one->home, std::vector{1.0, 2.0, 3.0}}) {
      const auto q = [&](const Scene& scene) {
        const auto model = make_model<double>(std::make_shared<const Scene>(scene),
                                              std::span<const double>(scene.default_parameters()));
        Workspace<double> ws(model);
        coordinates<double>(model, psi, 0.0, ws);
        return ws.q[static_cast<Eigen::Index>(j)];
      };
      EXPECT_NEAR(q(*other), q(*one), 1e-13) << one->coordinates[j].name;
    }
}

// Ten turns of the crank: the rocker's angle comes back, the coupler's has wound once a turn.
TEST(ClosedProgram, AngleWhoseValueCountsGoesOnThroughTurns) {
  const auto scene = shared(with(kWound, "coordinate: q3", "coordinate: q2"));
  Equations::Workspace programs(equations_of(scene, Evaluation::interpreter, {Purpose::energy}),
                                scene->default_parameters());
  std::vector<double> psi = scene->home;
  double energy[2], before = 0;
  programs.evaluate(Purpose::energy, {.psi = psi, .psid = std::vector{0.0}}, energy);
  before = energy[1];
  const double q2 = scene->coordinates[1].home, turn = 2 * std::numbers::pi;
  for (int k = 1; k <= 1000; ++k) {
    psi[0] = scene->home[0] + turn * k / 100;
    ASSERT_EQ(programs.evaluate(Purpose::energy, {.psi = psi, .psid = std::vector{0.0}}, energy), Status::ok);
  }
  // Relative to the crank the coupler has turned back ten times.
  const double wound = q2 - 10 * turn;
  EXPECT_NEAR(energy[1] - before, wound * wound - q2 * q2, 1e-9 * wound * wound);
}

TEST(ClosedProgram, OutOfReachIsAStatus) {
  // A rocker that is driven, and a crank that it can't turn round.
  const auto scene = shared(
      with(with(four_bar("rocker: 100 deg, q1: 60 deg, q2: -20 deg"), "motors: [crank]", "motors: [rocker]"),
           "{q1: crank}", "{q3: rocker}"));
  Equations::Workspace programs(equations_of(scene, Evaluation::interpreter, {Purpose::mass_matrix}),
                                scene->default_parameters());
  std::vector<double> psi{0.3}, M(1);
  EXPECT_EQ(programs.evaluate(Purpose::mass_matrix, {.psi = psi, .psid = {}}, M), Status::not_closed);
  EXPECT_TRUE(std::isnan(M[0]));
  psi = scene->home;
  EXPECT_EQ(programs.evaluate(Purpose::mass_matrix, {.psi = psi, .psid = {}}, M), Status::ok);
}

TEST(ClosedProgram, ReachesParametersFromTheDefaults) {
  const std::string text = with(kSpatialSliderCrank, "constants: {crank: 0.08 m, rod: 0.3 m,",
                                "parameters: {rod: 0.3 m}\nconstants: {crank: 0.08 m,");
  const auto scene = shared(text), longer = shared(with(text, "rod: 0.3 m", "rod: 0.4 m"));
  std::vector<double> M(1), expected(1), psi{0.2};
  Equations::Workspace far(equations_of(scene, Evaluation::interpreter, {Purpose::mass_matrix}),
                           std::vector{0.4}),
      near(equations_of(longer, Evaluation::interpreter, {Purpose::mass_matrix}), std::vector{0.4});
  ASSERT_EQ(far.evaluate(Purpose::mass_matrix, {.psi = psi, .psid = {}}, M), Status::ok);
  ASSERT_EQ(near.evaluate(Purpose::mass_matrix, {.psi = psi, .psid = {}}, expected), Status::ok);
  EXPECT_NEAR(M[0], expected[0], 1e-14 * expected[0]);
  Equations::Workspace procedure(equations_of(scene, Evaluation::reference, {Purpose::mass_matrix}),
                                 std::vector{0.4});
  ASSERT_EQ(procedure.evaluate(Purpose::mass_matrix, {.psi = psi, .psid = {}}, M), Status::ok);
  EXPECT_NEAR(M[0], expected[0], 1e-13 * expected[0]);
}

}  // namespace
}  // namespace mixloop
