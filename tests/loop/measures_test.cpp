// SPDX-License-Identifier: MIT
// What a run is judged by, and what of it was never measured.
#include "loop/measures.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "loop/arrivals.hpp"
#include "loop/result.hpp"

namespace mixloop {
namespace {

using testing::Contains;
using testing::HasSubstr;

Experiment shipped(const std::string& name, const std::vector<Override>& overrides = {}) {
  return load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS) / (name + ".yaml"), overrides);
}

/// Commands of the law, each 50 us after its state, and a safe state from a tick on.
Arrivals safe_from(std::int64_t tick, std::int64_t ticks) {
  Arrivals arrivals;
  for (std::int64_t k = 0; k <= ticks; ++k)
    arrivals.commands.push_back({.tick = k, .offset = k == 0 ? 0 : 50'000, .command = k});
  arrivals.interventions = {{.tick = tick, .cause = "a test"}};
  return arrivals;
}

struct Recorded {
  Measures measures;
  std::vector<double> largest_before;  ///< a motor, of the commands before the safe state
};

Recorded recorded(const Experiment& experiment, std::int64_t safe_tick) {
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  simulate_arrivals(run, safe_from(safe_tick, plan.ticks()), [](std::int64_t) { return true; });
  Recorded result{run.recorder().measures(), std::vector<double>(3, 0)};
  for (std::int64_t k = 0; k < safe_tick; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      result.largest_before[i] = std::max(result.largest_before[i], std::abs(run.recorder().commanded(k)[i]));
  return result;
}

TEST(Measures, OfARunThatNeverReachedThePathAreNoneAndHoldNoBound) {
  const Experiment experiment =
      shipped("move_to_start", {{"expect.safe_state", "true"}, {"expect.max_torque", "[9, 9, 9]"}});
  const Measures measures = recorded(experiment, 500).measures;
  ASSERT_EQ(measures.safe_at, 0.5);
  for (const double value : {measures.max_position_error, measures.time_of_max_position_error,
                             measures.final_position_error, measures.rms_position_error})
    EXPECT_TRUE(std::isnan(value)) << value;
  EXPECT_FALSE(measures.max_torque.hasNaN()) << "the move's commands count";
  const Result result = result_of(experiment, measures, "simulate", Evaluation::interpreter, 1);
  EXPECT_EQ(result.judged.verdict, Verdict::safe_state);
  EXPECT_THAT(result.judged.missed,
              testing::ElementsAre(HasSubstr("max_position_error was never measured; expected at most")));
  EXPECT_FALSE(result.run->bounds[0].held);
}

TEST(Measures, OfASafeStateFromTheFirstTickOnAreNone) {
  const Experiment experiment = shipped("paper", {{"expect", "{safe_state: true, max_torque: [9, 9, 9]}"}});
  const Measures measures = recorded(experiment, 0).measures;
  for (const double torque : measures.max_torque) EXPECT_TRUE(std::isnan(torque)) << torque;
  EXPECT_THAT(missed(experiment.expect, measures), Contains(HasSubstr("max_torque[0] was never measured")));
}

TEST(Measures, AreThoseBeforeTheSafeState) {
  const auto [measures, before] =
      recorded(shipped("paper", {{"controller.kv", "[20, 20, 20]"}, {"real_time.safe_state", "hold"}}), 400);
  ASSERT_EQ(measures.max_torque.size(), 3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(measures.max_torque[static_cast<Eigen::Index>(i)], before[i]);
  EXPECT_LT(measures.time_of_max_position_error, 0.4);
}

}  // namespace
}  // namespace mixloop
