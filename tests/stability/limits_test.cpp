// SPDX-License-Identifier: MIT
// The paper's loop: DESIGN's table of limits, the warnings, and the fate of disturbances.
#include <gtest/gtest.h>

#include "stability/confirmation.hpp"
#include "stability/survey.hpp"
#include "stability/warning.hpp"

namespace mixloop {
namespace {

Experiment experiment(const std::string& name, const std::vector<Override>& overrides = {}) {
  Experiment loaded =
      load_experiment(std::filesystem::path(MIXLOOP_SOURCE "/experiments/" + name + ".yaml"), overrides);
  loaded.evaluation = Evaluation::interpreter;
  return loaded;
}

Limits at_start(const Experiment& experiment) {
  const Survey instants = survey(experiment, make_plan(experiment), 2);
  return limits_of(instants.loops.front(), instants.sampling);
}

// Half a unit of the last digit given.
TEST(PapersLoop, HasTheLimitsThatTwoDerivationsAgreeOn) {
  const Limits limits = at_start(experiment("paper"));
  EXPECT_NEAR(limits.fastest_pole, -1430.9, 0.05);
  EXPECT_NEAR(limits.longest_tick.value(), 1.349e-3, 0.5e-6);
  EXPECT_NEAR(limits.longest_delay.value(), 0.651e-3, 0.5e-6);
  EXPECT_NEAR(limits.longest_rk4_step.value(), 1.947e-3, 0.5e-6);
}

TEST(PapersLoop, HasThemWithoutPayloadToo) {
  const Limits limits = at_start(experiment("paper", {{"parameters.payload", "0 kg"}}));
  EXPECT_NEAR(limits.fastest_pole, -1936.0, 0.05);
  EXPECT_NEAR(limits.longest_tick.value(), 1.006e-3, 0.5e-6);
  EXPECT_NEAR(limits.longest_delay.value(), 0.484e-3, 0.5e-6);
  EXPECT_NEAR(limits.longest_rk4_step.value(), 1.439e-3, 0.5e-6);
}

TEST(PapersLoop, DecaysBelowALimitAndGrowsAboveIt) {
  const Experiment paper = experiment("paper");
  const Plan plan = make_plan(paper);
  EXPECT_EQ(fate_of_disturbance(paper, plan, {1e-3, 0.99 * 0.651e-3}), Fate::decays);
  EXPECT_EQ(fate_of_disturbance(paper, plan, {1e-3, 1.01 * 0.651e-3}), Fate::grows);
  EXPECT_EQ(fate_of_disturbance(paper, plan, {0.99 * 1.349e-3, 0}), Fate::decays);
  EXPECT_EQ(fate_of_disturbance(paper, plan, {1.01 * 1.349e-3, 0}), Fate::grows);
}

std::vector<std::string> warnings(const std::string& name, const std::vector<Override>& overrides = {}) {
  const Experiment loaded = experiment(name, overrides);
  return stability_warnings(loaded, make_plan(loaded));
}

TEST(StabilityWarnings, AreForWhatIsNearOrPastALimit) {
  EXPECT_TRUE(warnings("paper").empty());
  EXPECT_TRUE(warnings("command_delay").empty());
  ASSERT_EQ(warnings("no_payload").size(), 1U);
  EXPECT_NE(warnings("no_payload")[0].find("is near its limit at 0.000 s"), std::string::npos);
  ASSERT_EQ(warnings("must_diverge").size(), 1U);
  EXPECT_NE(warnings("must_diverge")[0].find("is unstable at 0.000 s"), std::string::npos);
}

TEST(StabilityWarnings, KnowLongStepsOfContinuousControl) {
  EXPECT_TRUE(warnings("paper_continuous").empty());
  const auto said = warnings("paper_continuous", {{"rate", "500 Hz"}});
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("RK4 steps of 2.000 ms are too long at 0.000 s"), std::string::npos) << said[0];
}

TEST(StabilityMap, IsBelowOneWhereTheLimitsSay) {
  const Experiment paper = experiment("paper");
  const Survey instants = survey(paper, make_plan(paper), 3);
  EXPECT_LT(path_radius(instants, {1e-3, 0.64e-3}), 1);
  EXPECT_GT(path_radius(instants, {1e-3, 0.66e-3}), 1);
  const PathLimits limits = path_limits(instants);
  EXPECT_LE(limits.delay.value.value(), at_start(paper).longest_delay.value());
}

}  // namespace
}  // namespace mixloop
