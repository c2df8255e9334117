// SPDX-License-Identifier: MIT
// Numbers tuned: against a grid by the sweep, and against what simulate, sweep and stability make of the
// tuned experiment.
#include "tuning/tune.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "notation/long_work.hpp"
#include "sweep/sweep.hpp"
#include "sweep/written_run.hpp"
#include "tests/support/command.hpp"
#include "tests/support/simulated.hpp"
#include "tuning/minimise.hpp"

namespace mixloop {
namespace {

class Tuning : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_minimise()) GTEST_SKIP() << "built without NLopt: package libnlopt-dev";
  }

  /// The paper's line, or a fifth of a second of it.
  static TuneRequest gains(bool is_short = true) {
    TuneRequest request{.over = {"controller.kp,controller.kv"}, .goal = "max_position_error", .poses = 3};
    request.sweep.experiment = MIXLOOP_EXPERIMENTS "/paper.yaml";
    request.sweep.overrides = {{"expect", "{}"}};
    if (is_short)
      request.sweep.overrides.push_back(
          {"path", "{line: {from: [0.3, 0.0, 0.8], to: [0.26, 0.03, 0.76]}, duration: 0.2 s}"});
    return request;
  }
  static Problem problem(const TuneRequest& request, int threads = 2) {
    return Problem(request, threads, [] { return true; });
  }
  static Tuned tuned(const Problem& problem, std::int64_t evaluations = 120) {
    return tune(problem, evaluations, [](const TuneProgress&) {});
  }
  /// The tuned experiment, written and read back.
  Experiment written(const Problem& problem, const Tuned& tuned) const {
    const auto file = folder.path() / "tuned.yaml";
    write_experiment(file, "# tuned\n", problem.setup(), problem.overrides(tuned.best.values));
    return load_experiment(file, {});
  }
  static std::vector<Outcome> swept(const SweepRequest& request) {
    const Sweep sweep("test", request, Evaluation::machine_code, false);
    return run_batch(sweep.setup(), sweep.telling(), LaneEngine(), 0, sweep.runs(), [] { return true; });
  }

  const ScratchFolder folder;
};

TEST_F(Tuning, OfOneGainComesToTheBestOfAGridThatTheSweepGoesThrough) {
  TuneRequest request = gains();
  request.over = {"controller.kp[1]=2.5..250"};
  request.goal = "rms_position_error";
  request.subject = {"max_torque[1] <= 1.05 now"};
  const Problem one = problem(request);
  const Tuned found = tuned(one, 80);

  SweepRequest grid = request.sweep;
  grid.design.varied = {parse_varied("controller.kp[1]=5..250:50")};
  const Columns columns(one.setup().experiment(), false);
  const auto at = [&](const char* name) {
    return std::ranges::find(columns.all(), name, &Columns::Column::name) - columns.all().begin();
  };
  double least = 1e9, gain = 0;
  for (const Outcome& run : swept(grid)) {
    const auto value = [&](const char* name) { return run.values[static_cast<std::size_t>(at(name))]; };
    if (value("max_torque[1]") <= one.bounds()[0].limit && value("rms_position_error") < least)
      least = value("rms_position_error"), gain = 5.0 * static_cast<double>(run.run + 1);
  }
  ASSERT_TRUE(found.best.is_feasible() && found.improves);
  EXPECT_LE(found.best.goal, least) << "the grid has better ones: " << gain;
  EXPECT_NEAR(found.best.values[0], gain, 5) << "a step of the grid";
}

TEST_F(Tuning, TellsWhatSimulateAndStabilityMakeOfTheTunedExperiment) {
  TuneRequest request = gains(false);
  request.subject = {"max_torque <= now", "longest_delay >= now", "gain_margin.most >= now",
                     "spectral_radius <= now"};
  request.poses = 4;
  const Problem paper = problem(request);
  const Tuned found = tuned(paper);
  ASSERT_TRUE(found.best.is_feasible() && found.improves);
  EXPECT_LT(found.best.goal, 0.5 * paper.before().goal) << "half the error at the least";

  const Experiment experiment = written(paper, found);
  const Measures measures = simulated(experiment);
  EXPECT_EQ(measures.max_position_error, found.best.goal);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(measures.max_torque[static_cast<Eigen::Index>(i)], found.best.bounded[i]);
    EXPECT_LE(found.best.bounded[i], paper.before().bounded[i]);
  }
  const Survey instants = survey(experiment, make_plan(experiment), request.poses);
  EXPECT_EQ(path_limits(instants).delay.value, found.best.bounded[3]);
  EXPECT_GE(found.best.bounded[3], paper.before().bounded[3]);
  EXPECT_EQ(limits_of(instants.loops[0], instants.sampling).most_gain, found.best.bounded[4]);
  EXPECT_EQ(path_limits(instants).radius, found.best.bounded[5]);
}

TEST_F(Tuning, OverRunsCountsTheWorstOfThoseThatTheSweepHas) {
  TuneRequest request = gains();
  request.sweep.design.sampled = {parse_sampled("plant.parameters.payload=normal(5 kg, 0.5 kg)"),
                                  parse_sampled("plant.command_delay=uniform(0, 200 us)")};
  request.sweep.design.draws = 10;
  request.subject = {"longest_delay >= now", "max_torque <= now"};
  for (const double share : {1.0, 0.8}) {
    request.share = share;
    const Problem robust = problem(request);
    const Tuned found = tuned(robust, 40);
    ASSERT_TRUE(found.best.is_feasible());
    written(robust, found);
    SweepRequest sweep = request.sweep;
    sweep.experiment = folder.path() / "tuned.yaml";
    sweep.overrides = {};
    std::vector<double> errors;
    for (const Outcome& run : swept(sweep)) errors.push_back(run.values[0]);
    std::ranges::sort(errors);
    EXPECT_EQ(found.best.goal, errors[share == 1.0 ? 9 : 7]);
  }
}

TEST_F(Tuning, ComesToTheSameBytesEveryTimeByAnyNumberOfThreads) {
  TuneRequest request = gains();
  request.sweep.design.sampled = {parse_sampled("parameters.payload=normal(5 kg, 0.5 kg)")};
  request.sweep.design.draws = 9;
  request.subject = {"longest_delay >= now", "max_torque <= now"};
  request.poses = 2;
  const auto found = [&](int threads) {
    const Tuned one = tuned(problem(request, threads), 30);
    return std::tuple(one.best.values, one.best.goal, one.best.bounded, one.evaluations);
  };
  const auto first = found(1);
  EXPECT_EQ(found(1), first);
  EXPECT_EQ(found(3), first);
}

TEST_F(Tuning, MayMaximise) {
  TuneRequest request = gains();
  request.goal = "longest_delay";
  request.maximises = true;
  request.subject = {"max_position_error <= 1.1 now"};
  const Problem delay = problem(request);
  const Tuned found = tuned(delay, 80);
  EXPECT_TRUE(found.best.is_feasible());
  EXPECT_GT(found.best.goal, 1.05 * delay.before().goal);
}

TEST_F(Tuning, KnowsNothingBetterThanNoLimit) {
  TuneRequest request{.over = {"controller.gain"}, .goal = "longest_delay", .maximises = true};
  request.sweep.experiment = MIXLOOP_EXPERIMENTS "/cart_pole.yaml";
  request.sweep.overrides = {{"duration", "0.1 s"}, {"expect", "{}"}};
  const Problem held = problem(request);
  EXPECT_EQ(held.knobs().size(), 4U) << "of a list of lists";
  const Tuned found = tuned(held, 20);
  EXPECT_TRUE(found.best.is_feasible() && std::isinf(found.best.goal));
  EXPECT_FALSE(found.improves);
}

TEST_F(Tuning, BeginsWhereBoundsAreMissedOrRunsDiverge) {
  TuneRequest request = gains();
  request.goal = "max_torque";
  request.subject = {"max_position_error < 0.5 now"};
  const Problem missing = problem(request);
  EXPECT_FALSE(missing.before().is_feasible());
  EXPECT_TRUE(tuned(missing).best.is_feasible());

  request = gains();
  request.sweep.overrides.push_back({"plant.command_delay", "1 ms"});
  request.sweep.overrides.push_back({"limits.position_error", "30 mm"});
  const Problem diverging = problem(request);
  EXPECT_EQ(diverging.before().failed, 1);
  EXPECT_GT(diverging.before().lateness, 0);
  EXPECT_TRUE(std::isinf(diverging.before().goal));
  const Tuned found = tuned(diverging, 200);
  EXPECT_TRUE(found.best.is_feasible() && found.improves);
  EXPECT_LT(found.best.goal, 30e-3);
}

TEST_F(Tuning, ThatFindsNothingSaysWhatComesNearest) {
  TuneRequest request = gains();
  request.subject = {"max_position_error < 1e-9 m"};
  const Tuned found = tuned(problem(request), 40);
  EXPECT_FALSE(found.best.is_feasible());
  EXPECT_TRUE(found.improves) << "it comes nearer";
  EXPECT_LE(found.evaluations, 40);
}

TEST_F(Tuning, RefusesNowWhereThereIsNone) {
  TuneRequest request = gains();
  request.sweep.overrides.push_back({"plant.command_delay", "1 ms"});
  request.sweep.overrides.push_back({"limits.position_error", "30 mm"});
  request.subject = {"max_torque <= now"};
  EXPECT_THROW(problem(request), InputError);
}

TEST_F(Tuning, ThatIsInterruptedHasTheBestSoFar) {
  int asked = 0;
  const Problem paper(gains(), 1, [&] { return ++asked < 30; });
  const Tuned found = tuned(paper);
  EXPECT_TRUE(found.interrupted);
  EXPECT_LT(found.evaluations, 30);
  EXPECT_TRUE(found.best.is_feasible());
}

}  // namespace
}  // namespace mixloop
