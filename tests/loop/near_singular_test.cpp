// SPDX-License-Identifier: MIT
// Plants that go over to other independent coordinates where their closures come near a singular pose: the
// motion against that of other coordinates, and against Lagrange's equations with multipliers.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "loop/review.hpp"
#include "loop/simulate.hpp"
#include "loop/truth.hpp"
#include "tests/oracles/known_linkages.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using oracle::Linkage;
using Real = long double;
using State = oracle::LinkageVector<Real>;
using testing::HasSubstr;

Experiment experiment_named(const char* name, std::vector<Override> overrides = {}) {
  Experiment experiment =
      load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / (std::string(name) + ".yaml"), overrides);
  experiment.evaluation = Evaluation::interpreter;
  return experiment;
}

Experiment rocker(std::vector<Override> overrides = {}) {
  return experiment_named("four_bar_rocker_turns", std::move(overrides));
}

/// An experiment, its plan and its run.
struct Simulated {
  explicit Simulated(Experiment said)
      : experiment(std::move(said)), plan(make_plan(experiment)), plant(experiment, plan) {
    simulate(plant, [](std::int64_t) { return true; });
  }
  const Recorder& record() const { return plant.recorder(); }
  Measures measures() const { return record().measures(); }

  Experiment experiment;
  Plan plan;
  RecordedPlant plant;
};

/// Bars of a four-bar linkage: crank, coupler, rocker on a ground of 1 m, bodies as of four_bar.yaml.
Linkage<Real> bars(Real crank, Real coupler, Real rocker) {
  Linkage<Real> linkage = oracle::four_bar_linkage<Real>();
  linkage.bodies[0].centre.arms[0].x = crank / 2;
  linkage.bodies[1].centre.arms[0].x = crank;
  linkage.bodies[1].centre.arms[1].x = coupler / 2;
  linkage.bodies[2].centre.arms[0].x = rocker / 2;
  linkage.loops[0].arms[0].x = crank, linkage.loops[0].arms[1].x = coupler,
  linkage.loops[0].arms[2].x = -rocker;
  return linkage;
}

/// (crank, elbow, rocker) closed where the rocker is, near a guess.
State closed_by_rocker(const Linkage<Real>& linkage, State q) {
  for (int i = 0; i < 20; ++i) {
    const auto motion = oracle::motion_of(linkage.loops[0], q, q);
    q.head(2) -= motion.J.leftCols(2).partialPivLu().solve(motion.p);
  }
  return q;
}

State rates_by_rocker(const Linkage<Real>& linkage, const State& q, Real rate) {
  const auto J = oracle::motion_of(linkage.loops[0], q, q).J;
  State qd(3);
  qd[2] = rate;
  qd.head(2) = -J.leftCols(2).partialPivLu().solve(J.col(2) * rate);
  return qd;
}

using Torque = std::function<Real(int tick, const State& q, const State& qd)>;

/// What the rocker, and all, do from tick to tick of 1 ms, `torque` on the rocker.
std::vector<State> motion_of(const Linkage<Real>& linkage, const State& q0, const State& qd0, int ticks,
                             const Torque& torque, int columns = 4) {
  State x(6);
  x << q0, qd0;
  std::vector<State> all{x};
  for (int k = 0; k < ticks; ++k) {
    x = oracle::extrapolated(x, Real(0.001L), columns, [&](const State& at) {
      const State q = at.head(3), qd = at.tail(3);
      State tau = State::Zero(3), rate(6);
      tau[2] = torque(k, q, qd);
      rate << qd, oracle::linkage_accelerations(linkage, q, qd, tau);
      return rate;
    });
    all.push_back(x);
  }
  return all;
}

/// The shipped linkage at home, pushed as the experiment pushes it.
struct Start {
  Linkage<Real> linkage;
  State q, qd;
};
Start start_of_rocker(Real rate) {
  const Real degree = std::numbers::pi_v<long double> / 180;
  Start start{bars(0.3L, 0.9L, 0.8L), State(3), State(3)};
  start.q << 113 * degree, -82 * degree, static_cast<Real>(115 * std::numbers::pi / 180);
  start.q = closed_by_rocker(start.linkage, start.q);
  start.qd = rates_by_rocker(start.linkage, start.q, rate);
  return start;
}

/// Of the rocker's angle at any tick, rad.
double farthest(const Recorder& record, const std::vector<State>& expected) {
  double most = 0;
  for (std::int64_t k = 0; k < record.ticks_recorded(); ++k)
    most = std::max(
        most, std::abs(record.psi(k)[0] - static_cast<double>(expected[static_cast<std::size_t>(k)][2])));
  return most;
}

// Ten seconds by gauss8, under the experiment's torque, which is held over each tick.
TEST(NearSingular, AFourBarGoesThroughItsDeadPointsAsByMultipliers) {
  const Simulated run(rocker());
  const Measures measures = run.measures();
  EXPECT_EQ(measures.ticks, 10000) << measures.no_way_on.value_or("");
  EXPECT_LT(*measures.energy_drift, 1e-12);
  EXPECT_LT(*measures.closure_residual, 1e-14);
  EXPECT_EQ(*measures.switches, 1) << "the crank goes round";
  EXPECT_LT(*measures.closure_condition, 4);
  const Start at = start_of_rocker(2.5L);
  const auto expected = motion_of(at.linkage, at.q, at.qd, 10000, [&](int k, const State&, const State&) {
    return static_cast<Real>(2 * std::sin(3 * (k / 1000.0)));
  });
  EXPECT_LT(farthest(run.record(), expected), 1e-10);
  EXPECT_NEAR(static_cast<double>(expected.back()[2]), 2.497185190194, 1e-12)
      << "which the experiment expects";
  int dead_points = 0;
  for (std::int64_t k = 1; k <= measures.ticks; ++k)
    dead_points += (run.record().psid(k)[0] > 0) != (run.record().psid(k - 1)[0] > 0);
  EXPECT_EQ(dead_points, 32);
}

/// The same motion, let go by the crank.
Experiment by_crank(const Start& at, std::vector<Override> overrides) {
  overrides.push_back({"expect", "{}"});
  overrides.push_back({"plant.initial", fmt::format("[{:.17g} rad]", static_cast<double>(at.q[0]))});
  overrides.push_back({"plant.initial_rates", fmt::format("[{:.17g} rad/s]", static_cast<double>(at.qd[0]))});
  return experiment_named("four_bar_turns", overrides);
}

/// The rocker's angle by the crank's, with the law of cosines.
double rocker_of(double crank) {
  const double x = 0.3 * std::cos(crank) - 1, y = 0.3 * std::sin(crank), square = x * x + y * y;
  const double angle = std::atan2(y, x) - std::acos((square + 0.64 - 0.81) / (1.6 * std::sqrt(square)));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

TEST(NearSingular, TheMotionIsTheOneOfTheCrank) {
  const Simulated run(rocker({{"controller.torque", "[0 N m]"}, {"expect", "{}"}}));
  const Simulated crank(by_crank(start_of_rocker(2.5L), {{"duration", "10 s"}}));
  double most = 0;
  for (std::int64_t k = 0; k <= 10000; ++k)
    most = std::max(most, std::abs(run.record().psi(k)[0] - rocker_of(crank.record().psi(k)[0])));
  EXPECT_LT(most, 1e-10);
  EXPECT_LT(*run.measures().energy_drift, 1e-12);
}

// A method's error is the one that it makes in the crank's coordinates, and falls as its order says.
TEST(NearSingular, TheErrorIsTheMethodsOwn) {
  const Start at = start_of_rocker(2.5L);
  const auto expected =
      motion_of(at.linkage, at.q, at.qd, 2000, [](int, const State&, const State&) { return Real(0); });
  std::vector<double> errors;
  for (const char* substeps : {"1", "2"}) {
    const Simulated run(rocker({{"controller.torque", "[0 N m]"},
                                {"duration", "2 s"},
                                {"plant.integrator", "rk4"},
                                {"plant.substeps", substeps}}));
    errors.push_back(farthest(run.record(), expected));
  }
  const Simulated crank(by_crank(at, {{"duration", "2 s"}, {"plant.integrator", "rk4"}}));
  double cranks = 0;
  for (std::int64_t k = 0; k <= 2000; ++k)
    cranks = std::max(cranks, std::abs(rocker_of(crank.record().psi(k)[0]) -
                                       static_cast<double>(expected[static_cast<std::size_t>(k)][2])));
  EXPECT_LT(errors[0], 2 * cranks) << errors[0] << " by the rocker, " << cranks << " by the crank";
  EXPECT_GT(errors[0] / errors[1], 12) << errors[0] << " " << errors[1];
}

// No bar of it goes round: each angle comes to dead points of its own.
TEST(NearSingular, ATripleRockerSwitchesToAndFro) {
  const std::vector<Override> overrides{{"scene.constants.ground", "1 m"},
                                        {"scene.constants.short", "0.7 m"},
                                        {"scene.constants.long", "0.65 m"},
                                        {"scene.constants.side", "0.9 m"},
                                        {"scene.home", "{rocker: 110 deg, crank: 60 deg, elbow: -10 deg}"},
                                        {"controller.torque", "[0 N m]"},
                                        {"duration", "6 s"},
                                        {"plant.initial_rates", "[3 rad/s]"}};
  const Simulated run(rocker(overrides));
  const Measures measures = run.measures();
  EXPECT_EQ(measures.ticks, 6000) << measures.no_way_on.value_or("");
  EXPECT_GE(*measures.switches, 20);
  EXPECT_LT(*measures.energy_drift, 1e-11);
  Start at{bars(0.7L, 0.65L, 0.9L), State(3), State(3)};
  const auto& home = *run.experiment.scene;
  at.q << 0, 0, home.home[0];
  for (const auto& coordinate : home.coordinates) {
    if (coordinate.name == "crank") at.q[0] = coordinate.home;
    if (coordinate.name == "elbow") at.q[1] = coordinate.home;
  }
  at.q = closed_by_rocker(at.linkage, at.q);
  at.qd = rates_by_rocker(at.linkage, at.q, 3);
  const auto expected =
      motion_of(at.linkage, at.q, at.qd, 6000, [](int, const State&, const State&) { return Real(0); });
  EXPECT_LT(farthest(run.record(), expected), 1e-9);
}

/// A slider-crank by its slider, or by its crank.
std::string slider_crank(bool by_slider) {
  return fmt::format(R"(
name: slider-crank
motors: {}
coordinates: {}
transforms:
  - {{from: 0, to: crank, theta: crank, a: 0.3 m}}
  - {{from: crank, to: rod, theta: rod, a: 0.8 m}}
  - {{from: 0, to: slider, at: [0, 0, 0], prismatic: slide, axis: [1, 0, 0]}}
closures: [{{name: pin, coincide: [{{frame: rod}}, {{frame: slider}}], axes: [x, y]}}]
bodies:
  - {{frame: crank, mass: 1 kg, center_of_mass: [-0.15 m, 0, 0], inertia: {{xx: 0, yy: 0.01 kg m^2, zz: 0.02 kg m^2}}}}
  - {{frame: rod, mass: 2 kg, center_of_mass: [-0.4 m, 0, 0], inertia: {{xx: 0, yy: 0.05 kg m^2, zz: 0.05 kg m^2}}}}
  - {{frame: slider, mass: 3 kg}}
loads: [{{along: slide, stiffness: 40 N/m, rest: 0.7 m, damping: 0 N s/m}}]
gravity: [0, -9.81 m/s^2, 0]
home: {{crank: 60 deg, rod: -79 deg, slide: 0.9068532577896574 m}}
)",
                     by_slider ? "{slide: linear}" : "[crank]",
                     by_slider ? "[crank, rod]" : "[rod, {slide: linear}]");
}

// A length takes the place of an angle, and the load is along what is no longer independent.
TEST(NearSingular, ASliderCrankGoesThroughItsDeadPointsByItsSlider) {
  const ScratchFolder folder;
  folder.write("by_slider.yaml", slider_crank(true));
  folder.write("by_crank.yaml", slider_crank(false));
  const auto load = [&](const std::string& text) {
    const std::string file = folder.file("experiment.yaml");
    Experiment experiment = load_experiment(parse_document(text + "duration: 4 s\n", file), file, {});
    experiment.evaluation = Evaluation::interpreter;
    return experiment;
  };
  const Simulated crank(
      load("scene: by_crank.yaml\ncontroller: {law: torque, torque: [0 N m]}\n"
           "plant: {integrator: gauss8, initial_rates: [9 rad/s]}\n"));
  const double c = std::numbers::pi / 3, s = 0.3 * std::sin(c), root = std::sqrt(0.64 - s * s);
  const double rate = -9 * (s + 0.3 * std::cos(c) * s / root);
  const std::string start =
      fmt::format("initial: [{:.17g} m], initial_rates: [{:.17g} m/s]", 0.3 * std::cos(c) + root, rate);
  const Simulated slider(
      load("scene: by_slider.yaml\ncontroller: {law: torque, torque: [0 N]}\n"
           "plant: {integrator: gauss8, near_singular: switch, " +
           start + "}\n"));
  ASSERT_EQ(slider.measures().ticks, 4000) << slider.measures().no_way_on.value_or("");
  EXPECT_GE(*slider.measures().switches, 1);
  double most = 0;
  for (std::int64_t k = 0; k <= 4000; ++k) {
    const double angle = crank.record().psi(k)[0], up = 0.3 * std::sin(angle);
    most = std::max(most,
                    std::abs(slider.record().psi(k)[0] - 0.3 * std::cos(angle) - std::sqrt(0.64 - up * up)));
  }
  EXPECT_LT(most, 1e-11);
  EXPECT_LT(*slider.measures().energy_drift, 1e-12);
  const Simulated driven(
      load("scene: by_slider.yaml\ncontroller: {law: torque, torque: [\"8 N * sin(5 rad/s * t)\"]}\n"
           "plant: {integrator: gauss8, near_singular: switch, " +
           start + "}\n"));
  EXPECT_EQ(driven.measures().ticks, 4000);
  EXPECT_LT(*driven.measures().energy_drift, 1e-12);
}

// Three motors, of which one is exchanged; all three pull.
TEST(NearSingular, APlatformOfThreeMotorsGoesThroughASingularPose) {
  const std::vector<Override> pushed{
      {"plant.initial_rates", "[0, 0, 12 rad/s]"}, {"expect", "{}"}, {"duration", "1 s"}};
  EXPECT_TRUE(Simulated(experiment_named("planar_3rrr_swing", pushed)).measures().no_way_on);
  auto through = pushed;
  through.push_back({"plant.near_singular", "switch"});
  const Measures measures = Simulated(experiment_named("planar_3rrr_swing", through)).measures();
  EXPECT_EQ(measures.ticks, 1000) << measures.no_way_on.value_or("");
  EXPECT_GE(*measures.switches, 1);
  EXPECT_LT(*measures.energy_drift, 1e-12);
}

// Where none is near, the motion is the one of the declared coordinates to rounding.
TEST(NearSingular, SwitchingChangesNothingWhereNoPoseIsSingular) {
  const Measures measures =
      Simulated(experiment_named("seven_bodies", {{"plant.near_singular", "switch"}})).measures();
  EXPECT_EQ(*measures.switches, 0);
  EXPECT_NEAR((*measures.final_psi)[0], 15.810771195153707, 1e-12);
}

// Drives with friction and a command delay look at the declared coordinate at every stage.
TEST(NearSingular, DrivesWorkOnTheDeclaredCoordinate) {
  const Simulated run(rocker(
      {{"duration", "3 s"}, {"expect", "{}"}, {"plant.actuators", "{friction: {viscous: [0.5 N m s]}}"}}));
  ASSERT_EQ(run.measures().ticks, 3000) << run.measures().no_way_on.value_or("");
  const Start at = start_of_rocker(2.5L);
  const auto expected = motion_of(at.linkage, at.q, at.qd, 3000, [&](int k, const State&, const State& qd) {
    return static_cast<Real>(2 * std::sin(3 * (k / 1000.0))) - 0.5L * qd[2];
  });
  EXPECT_LT(farthest(run.record(), expected), 1e-10);
}

// A command that acts from within the tick on: work and motion are of both.
TEST(NearSingular, ACommandMayActWithinATick) {
  const Simulated run(rocker({{"plant.command_delay", "0.4 ms"}, {"duration", "3 s"}}));
  EXPECT_EQ(run.measures().ticks, 3000);
  EXPECT_LT(*run.measures().energy_drift, 1e-12);
}

TEST(NearSingular, ControlMayBeContinuous) {
  const Simulated run(rocker({{"plant.control", "continuous"}, {"duration", "3 s"}}));
  ASSERT_EQ(run.measures().ticks, 3000);
  EXPECT_LT(*run.measures().energy_drift, 1e-12);
  const Simulated held(rocker({{"duration", "3 s"}}));
  EXPECT_NEAR(run.record().psi(3000)[0], held.record().psi(3000)[0], 0.05) << "the torque differs by a tick";
}

// What a record tells of a tick: by the linkage's own accelerations.
TEST(NearSingular, TheTruthIsOfTheMechanism) {
  const Simulated run(rocker({{"duration", "2 s"}}));
  const Start at = start_of_rocker(2.5L);
  const auto torque = [](int k) { return static_cast<Real>(2 * std::sin(3 * (k / 1000.0))); };
  const auto expected =
      motion_of(at.linkage, at.q, at.qd, 2000, [&](int k, const State&, const State&) { return torque(k); });
  TruthReader reader(run.experiment, run.record());
  for (const std::int64_t k : {0, 100, 500, 777, 1500, 2000}) {
    const Truth& truth = reader.at(k);
    const State &x = expected[static_cast<std::size_t>(k)], q = x.head(3), qd = x.tail(3);
    State tau = State::Zero(3);
    tau[2] = torque(static_cast<int>(k));
    const State qdd = oracle::linkage_accelerations(at.linkage, q, qd, tau);
    EXPECT_NEAR(truth.psidd[0], static_cast<double>(qdd[2]), 1e-7) << k;
    EXPECT_NEAR(truth.position[0], static_cast<double>(1 + 0.8L * std::cos(q[2])), 1e-9) << k;
    EXPECT_NEAR(truth.velocity[1], static_cast<double>(0.8L * std::cos(q[2]) * qd[2]), 1e-8) << k;
    EXPECT_NEAR(truth.acceleration[1],
                static_cast<double>(0.8L * (std::cos(q[2]) * qdd[2] - std::sin(q[2]) * qd[2] * qd[2])), 1e-7)
        << k;
  }
}

TEST(NearSingular, StatesPutBackGiveTheSameBytesAgain) {
  const Experiment experiment =
      rocker({{"duration", "3 s"},
              {"plant.actuators", "{time_constant: [2 ms], friction: {viscous: [0.1 N m s]}}"},
              {"expect", "{}"}});
  const Plan plan = make_plan(experiment);
  Plant plant = make_plant(experiment, plan), other = make_plant(experiment, plan);
  const auto course = [](Plant& it, int ticks) {
    std::vector<double> seen;
    for (int i = 0; i < ticks; ++i) {
      const double tau[] = {std::sin(0.01 * static_cast<double>(it.tick()))};
      it.command(tau);
      it.advance();
      seen.insert(seen.end(), {it.psi()[0], it.psid()[0], it.applied()[0], it.work(),
                               static_cast<double>(it.switches())});
    }
    return seen;
  };
  std::vector<PlantState> kept;
  const auto all = course(plant, 1000);
  ASSERT_GE(plant.switches(), 1);
  Plant again = make_plant(experiment, plan);
  for (int k = 0; k < 1000; ++k) {
    kept.push_back(again.state());
    course(again, 1);
  }
  EXPECT_TRUE(again.state() == plant.state());
  for (int k = 990; k >= 0; k -= 9) {
    other.put_back(kept[static_cast<std::size_t>(k)]);
    EXPECT_TRUE(other.state() == kept[static_cast<std::size_t>(k)]) << k;
    const auto rest = course(other, 9);
    ASSERT_TRUE(std::equal(rest.begin(), rest.end(), all.begin() + 5 * k)) << k;
  }
}

TEST(NearSingular, TicksAllocateNothing) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const Experiment experiment = rocker();
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  TruthReader truth(experiment, run.recorder());
  ASSERT_TRUE(run.begin());
  const AllocationCounter counter;
  const double tau[] = {0.1};
  for (int k = 0; k < 600; ++k) {
    run.lockstep_tick(tau, {}, [](std::int64_t) { return true; });
    truth.at(k);
  }
  EXPECT_EQ(counter.count(), 0U) << counter.first_caller();
  EXPECT_GE(run.plant().switches(), 1);
}

TEST(NearSingular, StopsThereUnlessToldToSwitch) {
  const Simulated run(rocker({{"plant.near_singular", "stop"}}));
  const Measures measures = run.measures();
  ASSERT_TRUE(measures.no_way_on);
  EXPECT_THAT(*measures.no_way_on, HasSubstr("the closure 'loop'"));
  EXPECT_LT(*measures.diverged_at, 1);
  EXPECT_FALSE(measures.switches);
}

// Crank and ground are as long as coupler and rocker together: where all lie in a line, no three angles of it
// say how it goes on.
TEST(NearSingular, StopsWhereNoCoordinatesHelp) {
  const Simulated run(rocker({{"scene.constants.long", "0.8 m"},
                              {"scene.constants.side", "0.5 m"},
                              {"scene.home", "{rocker: 140 deg, crank: 100 deg, elbow: -60 deg}"},
                              {"controller.torque", "[0 N m]"},
                              {"expect", "{}"},
                              {"plant.initial_rates", "[6 rad/s]"}}));
  const Measures measures = run.measures();
  ASSERT_TRUE(measures.no_way_on);
  EXPECT_THAT(*measures.no_way_on, HasSubstr("rocker = "));
  const double crank_pose = std::remainder(run.record().psi(measures.ticks)[0], std::numbers::pi);
  EXPECT_LT(std::abs(crank_pose), 0.3) << "the bars lie in a line";
}

TEST(NearSingular, RefusesWhatItCannotServe) {
  struct Row {
    const char* experiment;
    std::vector<Override> overrides;
    const char *code, *why;
  };
  const Override switches{"plant.near_singular", "switch"};
  for (const Row& row :
       {Row{"four_bar_rocker_turns",
            {{"plant.integrator", "rodas4"}},
            "out_of_range",
            "rodas4 takes the linearisation"},
        Row{"four_bar_rocker_turns",
            {{"plant.integrator", "auto"}},
            "out_of_range",
            "integrator: auto takes"},
        Row{"four_bar_rocker_turns", {{"plant.near_singular", "jump"}}, "unknown_value", "'stop', 'switch'"},
        Row{"four_bar_path", {switches}, "out_of_range", "a path is planned"},
        Row{"four_bar_swing", {switches}, "out_of_range", "near_singular is of closures"},
        Row{"double_four_bar_closed", {switches}, "out_of_range", "near_singular is of closures"}}) {
    const auto error = input_error([&] { experiment_named(row.experiment, row.overrides); });
    ASSERT_TRUE(error) << row.why;
    EXPECT_EQ(error->code, row.code);
    EXPECT_THAT(error->what(), HasSubstr(row.why));
  }
}

TEST(NearSingular, SaysNothingOfStepsInCoordinatesThatItLeft) {
  const Simulated run(rocker({{"duration", "1 s"}}));
  EXPECT_THAT(review(run.experiment, run.plan, run.record()), testing::IsEmpty());
}

}  // namespace
}  // namespace mixloop
