// SPDX-License-Identifier: MIT
// Motion without a path: closed forms, energy, and what doesn't go together.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "loop/result.hpp"
#include "loop/review.hpp"
#include "loop/simulate.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"
#include "tests/support/simulated.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

/// A bar of 2 m about its end, J = 4 kg m^2, with nothing but its motor, and no end effector.
constexpr const char* kLink = R"(
name: link
motors: [theta]
coordinates: [q]
constraints: {q: theta}
transforms: [{from: 0, to: bar, theta: q, a: 2 m}]
bodies: [{frame: bar, mass: 3 kg, center_of_mass: [-1 m, 0, 0], inertia: {xx: 0, yy: 1 kg m^2, zz: 1 kg m^2}}]
)";

class FreeMotion : public testing::Test {
 protected:
  FreeMotion() { folder_.write("link.yaml", kLink); }

  Experiment load(const std::string& text, const std::vector<Override>& overrides = {}) const {
    const std::string file = folder_.file("experiment.yaml");
    Experiment experiment =
        load_experiment(parse_document("scene: link.yaml\n" + text, file), file, overrides);
    experiment.evaluation = Evaluation::interpreter;
    return experiment;
  }

  const ScratchFolder folder_;
};

constexpr const char* kPushed = "duration: 2 s\ncontroller: {law: torque, torque: [3 N m]}\n";

// theta = tau t^2 / (2 J), exactly what a method of second order or more makes of it.
TEST_F(FreeMotion, OfALinkUnderAConstantTorqueIsAParabola) {
  const Measures measures = simulated(load(kPushed));
  ASSERT_TRUE(measures.final_psi);
  EXPECT_NEAR((*measures.final_psi)[0], 3.0 * 2 * 2 / (2 * 4), 1e-13) << "2000 ticks' rounding";
  EXPECT_EQ(measures.max_torque[0], 3);
  EXPECT_EQ(measures.ticks, 2000);
  EXPECT_FALSE(measures.follows_path);
  ASSERT_TRUE(measures.energy_drift);
  EXPECT_LT(*measures.energy_drift, 1e-13) << "the motor's work became energy";
}

// 1/2 J w^2 = W: a method of first order misses what it misses, the work being that of its own steps.
TEST_F(FreeMotion, OfACrudeMethodShowsItsDrift) {
  const Measures measures =
      simulated(load(std::string(kPushed) + "plant: {integrator: semi_implicit_euler}"));
  // psi' is exact; the way, and so the work, is too long by tau h t / (2 J).
  EXPECT_NEAR(*measures.energy_drift, 1e-3 / 2, 1e-6);
}

TEST_F(FreeMotion, BeginsWhereAndAsFastAsThePlantSays) {
  const Measures measures =
      simulated(load("duration: 2 s\ncontroller: {law: torque, torque: [0]}\n"
                     "plant: {initial: [90 deg], initial_rates: [0.5 rad/s]}"));
  EXPECT_NEAR((*measures.final_psi)[0], std::numbers::pi / 2 + 0.5 * 2, 1e-12) << "2000 ticks' rounding";
}

// tau = 3 t: theta = t^3 / 8, in each tick with the torque of its beginning.
TEST_F(FreeMotion, TakesTorquesAtTheTicksOrAtEveryStage) {
  const char* ramp = "duration: 2 s\ncontroller: {law: torque, torque: [3 N m/s * t]}\n";
  const double held = (*simulated(load(ramp)).final_psi)[0];
  const double throughout =
      (*simulated(load(std::string(ramp) + "plant: {control: continuous}")).final_psi)[0];
  EXPECT_NEAR(throughout, 3.0 * 8 / (6 * 4), 1e-12);
  EXPECT_NEAR(throughout - held, 3.0 / 4 * 0.5e-3 * 2 * 2 / 2, 1e-6) << "half a tick late";
}

TEST_F(FreeMotion, TakesTorquesFromAFileBesideTheExperiment) {
  folder_.write("pulse.csv", "t,tau\n0,4\n1,0\n");
  const Measures measures = simulated(load("duration: 2 s\ncontroller: {law: torque, file: pulse.csv}"));
  EXPECT_NEAR((*measures.final_psi)[0], 0.5 + 1, 1e-13) << "a second of 1 rad/s^2, then 1 rad/s";
}

TEST_F(FreeMotion, CountsTheFileOfABaseFromTheBasesFolder) {
  std::filesystem::create_directory(folder_.path() / "below");
  folder_.write("below/pulse.csv", "0,4\n");
  folder_.write("below/base.yaml",
                "scene: ../link.yaml\nduration: 1 s\ncontroller: {law: torque, file: pulse.csv}\n");
  const std::string file = folder_.file("top.yaml");
  const Experiment top = load_experiment(parse_document("base: below/base.yaml", file), file, {});
  EXPECT_NEAR((*simulated(top).final_psi)[0], 0.5, 1e-13);
}

// J theta'' = -K (theta - 1) - D theta': critically damped, 100 = 25 * 4, 40 = 2 * 5 * 4.
TEST_F(FreeMotion, ComesToRestWhereItIsFedBackAbout) {
  const Measures measures = simulated(
      load("duration: 4 s\ncontroller: {law: state_feedback, gain: [[100, 40]], about: {psi: [1 rad]}}\n"
           "expect: {final: [1 rad], tolerance: 1e-6 rad, energy_drift: 1e-12, max_torque: [100]}"));
  EXPECT_NEAR((*measures.final_psi)[0], 1, 1e-7);
}

TEST_F(FreeMotion, IsJudgedByItsEndAndItsEnergy) {
  const Experiment good =
      load(std::string(kPushed) + "expect: {final: [1.5], tolerance: [1e-9], energy_drift: 1e-12}");
  EXPECT_EQ(judge(good, simulated(good)).verdict, Verdict::held);
  const Experiment bad = load(std::string(kPushed) +
                              "plant: {integrator: semi_implicit_euler}\n"
                              "expect: {final: [1.4 rad], tolerance: 0.01 rad, energy_drift: 1e-9}");
  const Judgement judged = judge(bad, simulated(bad));
  EXPECT_EQ(judged.verdict, Verdict::missed);
  EXPECT_THAT(
      judged.missed,
      testing::ElementsAre(testing::MatchesRegex("final_psi\\[0\\] is 1.50.* rad; expected 1.39 to 1.41 rad"),
                           testing::MatchesRegex("energy_drift is 0.000[45].*; expected at most 1e-09")));
}

TEST_F(FreeMotion, OfWhatLosesEnergyOtherwiseHasNoDrift) {
  const Experiment damped = load(kPushed, {{"scene.loads", "[{coordinate: q, damping: 0.1 N m s}]"}});
  EXPECT_FALSE(simulated(damped).energy_drift);
}

TEST_F(FreeMotion, OfNoEnergyAtAllDriftsByNothing) {
  EXPECT_EQ(simulated(load("duration: 10 ms\ncontroller: {law: torque, torque: [0]}")).energy_drift, 0.0);
}

TEST_F(FreeMotion, DivergesWhereItIsNotFinite) {
  const Experiment experiment =
      load("duration: 1 s\ncontroller: {law: torque, torque: [\"1 N m s / (t - 0.5 s)\"]}");
  const Measures measures = simulated(experiment);
  EXPECT_EQ(measures.diverged_at, 0.5);
  EXPECT_EQ(judge(experiment, measures).exit_status, kRunFault);
}

TEST_F(FreeMotion, HasNoPlanButItsTicks) {
  const Plan plan = make_plan(load(kPushed));
  EXPECT_FALSE(plan.has_path());
  EXPECT_EQ(plan.ticks(), 2000);
  EXPECT_EQ(plan.at(5).psi[0], 0);
  EXPECT_TRUE(std::isnan(plan.at(5).position[0]));
  EXPECT_TRUE(std::isnan(plan.at_stage(3000, 2).position[2]));
}

TEST_F(FreeMotion, IsToldFromOthersByWhatItsPeersMustHaveInCommon) {
  const auto path_of = [&](const std::string& text) { return common_ground(load(text))[2]; };
  EXPECT_NE(path_of(kPushed), path_of("duration: 3 s\ncontroller: {law: torque, torque: [3 N m]}\n"));
  EXPECT_NE(path_of(kPushed), path_of(std::string(kPushed) + "plant: {initial_rates: [1]}"));
}

TEST_F(FreeMotion, GoesSafeWithoutGains) {
  EXPECT_EQ(load(kPushed).deadline.safe_state, SafeState::zero_torque);
  EXPECT_EQ(load(std::string(kPushed) + "real_time: {safe_state: brake}").deadline.safe_state,
            SafeState::brake);
}

class DoesNotGoTogether : public FreeMotion, public testing::WithParamInterface<BadInput> {};

TEST_P(DoesNotGoTogether, IsRefusedAtItsPlace) {
  expect_refused(GetParam(), [&](const std::string& text, const std::string& file) {
    make_plan(load_experiment(parse_document(text, file), folder_.file("experiment.yaml"), {}));
  });
}

#define LINK "scene: link.yaml\n"
#define FREE LINK "duration: 1 s\ncontroller: {law: torque, torque: [0]}\n"
#define ROBOT "scene: " MIXLOOP_SCENES "/mixed_loop_robot.yaml\n"
#define LINE "path: {line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, duration: 1 s}\n"

INSTANTIATE_TEST_SUITE_P(
    Rows, DoesNotGoTogether,
    testing::Values(
        BadInput{"both", ROBOT LINE "duration: @1 s\ncontroller: {law: torque, torque: [0, 0, 0]}",
                 "doubly_defined", "both 'path' and 'duration'; expected one of them"},
        BadInput{"neither", "@scene: link.yaml\ncontroller: {law: torque, torque: [0]}", "missing_key",
                 "lacks 'path' or 'duration'"},
        BadInput{"no_end_effector",
                 LINK "path: @{line: {from: [0], to: [1]}, duration: 1 s}\n"
                      "controller: {law: torque, torque: [0]}",
                 "missing_key", "names no end_effector"},
        BadInput{"off_the_grid", LINK "duration: @1.0005 s\ncontroller: {law: torque, torque: [0]}",
                 "off_grid", "whole number"},
        BadInput{"no_time", LINK "duration: @0 s\ncontroller: {law: torque, torque: [0]}", "out_of_range",
                 "expected more than 0"},
        BadInput{"no_time_at_all", LINK "duration: @1 m\ncontroller: {law: torque, torque: [0]}",
                 "wrong_dimension", "duration"},
        BadInput{"too_long", LINK "duration: @1e9 s\ncontroller: {law: torque, torque: [0]}", "too_large",
                 "the duration"},
        BadInput{
            "law_of_a_path", LINK "duration: 1 s\ncontroller: {law: @pd, kp: [1], kv: [1]}", "out_of_range",
            "the law 'pd' follows a path, and the experiment has none; expected torque or state_feedback"},
        BadInput{"limit", FREE "limits: {position_error: @1 m}", "out_of_range",
                 "limits.position_error is of a path"},
        BadInput{"limit_of_a_plan", FREE "limits: {torque: @[1]}", "out_of_range",
                 "limits.torque is of a path"},
        BadInput{"error", FREE "expect: {max_position_error: @1 mm}", "out_of_range",
                 "without a path there is no max_position_error"},
        BadInput{"start_tolerance",
                 LINK
                 "duration: 1 s\ncontroller: {law: torque, torque: [0], safety: {start_tolerance: @[1]}}",
                 "out_of_range", "start_tolerance is of a path's start"},
        BadInput{"automatic", FREE "plant: {integrator: @auto}", "out_of_range", "looks along a path"},
        BadInput{"late_fault", FREE "faults: [{at: @2 s, motor: 1, kind: \"off\"}]", "out_of_range",
                 "or a longer duration"},
        BadInput{"rates_of_a_path",
                 ROBOT LINE
                 "controller: {law: torque, torque: [0, 0, 0]}\nplant: {initial_rates: @[0, 0, 1]}",
                 "out_of_range", "beside a duration alone"},
        BadInput{"too_few_rates", FREE "plant: {initial_rates: @[0, 0]}", "wrong_size",
                 "the initial rate has 2"},
        BadInput{"rate_is_no_position", FREE "plant: {initial_rates: [@1 m]}", "wrong_dimension",
                 "the initial rate"},
        BadInput{"about_and_reference",
                 ROBOT LINE
                 "controller: {law: state_feedback, gain: [[1,0,0,1,0,0],[0,1,0,0,1,0],[0,0,1,0,0,1]],"
                 " about: {psi: @[0, 0, 0]}}",
                 "out_of_range", "expected no about.psi"},
        BadInput{"servo_without_gains", FREE "real_time: {safe_state: @hold}", "out_of_range",
                 "takes kp and kv, which the controller's law has not"},
        BadInput{"end_without_tolerance", FREE "expect: {final: @[0]}", "missing_key", "lacks 'tolerance'"},
        BadInput{"tolerance_without_end", FREE "expect: {tolerance: @1e-9}", "missing_key", "lacks 'final'"},
        BadInput{"ends", FREE "expect: {final: @[0, 1], tolerance: 1}", "wrong_size",
                 "the final position has 2"},
        BadInput{"negative_tolerance", FREE "expect: {final: [0], tolerance: @-1}", "out_of_range",
                 "0 or more"},
        BadInput{"negative_drift", FREE "expect: {energy_drift: @-1e-9}", "out_of_range", "never below 0"},
        BadInput{"not_judged", FREE "expect: {diverges: true, final: @[0], tolerance: 1}", "out_of_range",
                 "no bound on final_psi is judged"}),
    bad_input_name);

TEST_F(FreeMotion, HasNoDriftToExpectWhereOthersDoWork) {
  const auto why = [&](const std::vector<Override>& overrides) {
    const auto error =
        input_error([&] { load(std::string(kPushed) + "expect: {energy_drift: 1e-9}", overrides); });
    return error ? std::string(error->what()) : "";
  };
  EXPECT_THAT(why({{"scene.loads", "[{coordinate: q, damping: 0.1 N m s}]"}}),
              HasSubstr("damping takes energy"));
  EXPECT_THAT(why({{"scene.loads", "[{frame: bar, force: [1 N, 0, 0]}]"}}), HasSubstr("external forces"));
  EXPECT_THAT(why({{"scene.constraints.q", "theta + 1 rad/s * t"}}), HasSubstr("depend on time"));
  EXPECT_THAT(why({{"scene.parameters", "{load: 1 kg}"},
                   {"scene.bodies[0].mass", "3 kg + load"},
                   {"faults", "[{at: 1 s, parameter: load, value: 0 kg}]"}}),
              HasSubstr("a fault changes a parameter"));
}

// It passes upright, where a motion grows by e^3.4 a second: soon it isn't there any more, and its steps are
// fine enough all the same.
TEST(FreeSwing, IsNotHeldAgainstAPoseThatItSoonLeaves) {
  Experiment experiment = load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / "four_bar_swing.yaml",
                                          {{"duration", "200 s"}, {"expect", "{}"}});
  experiment.evaluation = Evaluation::interpreter;
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  EXPECT_THAT(review(experiment, plan, run.recorder()), testing::IsEmpty());
  EXPECT_FALSE(step_doubt(experiment, plan));
}

// By gains that are Kp and Kv, along a path, it is that law, to the bit.
TEST(StateFeedbackAlongAPath, IsThatLawOfWhichItHasTheGains) {
  const auto hash = [](const std::vector<Override>& overrides) {
    Experiment experiment =
        load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / "paper.yaml", overrides);
    experiment.evaluation = Evaluation::interpreter;
    const Plan plan = make_plan(experiment);
    RecordedPlant run(experiment, plan);
    simulate(run, [](std::int64_t) { return true; });
    const Measures measures = run.recorder().measures();
    EXPECT_FALSE(measures.final_psi || measures.energy_drift);
    EXPECT_LT(measures.max_position_error, 0.1);
    return measures.trajectory_sha256;
  };
  EXPECT_EQ(hash({{"controller", "{law: pd, kp: [100, 25, 25], kv: [1.0, 0.5, 0.5]}"}}),
            hash({{"controller",
                   "{law: state_feedback, gain: [[100, 0, 0, 1, 0, 0], [0, 25, 0, 0, 0.5, 0], "
                   "[0, 0, 25, 0, 0, 0.5]]}"}}));
}

// A bound on the end, and on the energy that the motors' work brings, may stand beside a path.
TEST(EnergyAlongAPath, IsTheMotorsWorkToTheIntegratorsError) {
  const Experiment experiment = load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / "paper.yaml",
                                                {{"expect", "{energy_drift: 1e-6}"}});
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate(run, [](std::int64_t) { return true; });
  const Measures measures = run.recorder().measures();
  ASSERT_TRUE(measures.energy_drift);
  EXPECT_LT(*measures.energy_drift, 1e-6);
  EXPECT_TRUE(measures.follows_path);
}

}  // namespace
}  // namespace mixloop
