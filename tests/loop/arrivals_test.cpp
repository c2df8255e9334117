// SPDX-License-Identifier: MIT
#include "loop/arrivals.hpp"

#include <gmock/gmock.h>

#include "loop/arrivals_file.hpp"
#include "loop/simulate.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

Experiment paper(const std::vector<Override>& overrides = {}) {
  return load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"), overrides);
}

Measures measured(const Experiment& experiment, const Arrivals* arrivals) {
  const Plan plan = make_plan(experiment);
  RecordedPlant run(experiment, plan);
  const auto go_on = [](std::int64_t) { return true; };
  if (arrivals)
    simulate_arrivals(run, *arrivals, go_on);
  else
    simulate(run, go_on);
  return run.recorder().measures();
}

Arrivals all_after(std::int64_t offset, std::int64_t ticks = 1000) {
  Arrivals arrivals;
  for (std::int64_t k = 0; k <= ticks; ++k)
    arrivals.commands.push_back({.tick = k, .offset = k == 0 ? 0 : offset, .command = k});
  return arrivals;
}

TEST(Arrivals, AtOnceAreLockstepToTheBit) {
  const auto arrivals = all_after(0);
  EXPECT_EQ(measured(paper(), &arrivals).trajectory_sha256, measured(paper(), nullptr).trajectory_sha256);
}

// The tick is split at the same place; only 1e-9 * 400000 and 0.4 / 1000 may round apart, by 5e-20 s.
TEST(Arrivals, AfterAFixedTimeAreACommandDelay) {
  const auto arrivals = all_after(400'000);
  const Measures late = measured(paper(), &arrivals);
  const Measures delayed = measured(paper({{"plant.command_delay", "400 us"}}), nullptr);
  EXPECT_NEAR(late.max_position_error, delayed.max_position_error, 1e-12);
  EXPECT_NEAR(late.final_position_error, delayed.final_position_error, 1e-12);
}

TEST(Arrivals, AndACommandDelayAddUp) {
  const auto arrivals = all_after(150'000);
  const Measures both = measured(paper({{"plant.command_delay", "250 us"}}), &arrivals);
  const Measures delayed = measured(paper({{"plant.command_delay", "400 us"}}), nullptr);
  EXPECT_NEAR(both.max_position_error, delayed.max_position_error, 1e-12);
}

TEST(Arrivals, ThatStopBringTheSafeState) {
  auto arrivals = all_after(50'000);
  arrivals.commands.resize(300);  // command 299 is the last
  const Measures measures = measured(paper({{"real_time.max_missed", "20"}}), &arrivals);
  ASSERT_TRUE(measures.safe_at);
  EXPECT_DOUBLE_EQ(*measures.safe_at, 0.321) << "ticks 300 to 320 are 21 misses";
  EXPECT_EQ(measures.ticks, 1000);
  EXPECT_FALSE(measures.diverged_at);
}

// Up to 10 ms on, psi'' of a cycloid of 1 s is off by up to 2 pi 0.01 of its largest: 6 %, for 10 ms of the
// second.
TEST(Arrivals, KnowOfExtrapolatedReferences) {
  auto arrivals = all_after(50'000);
  const Measures plain = measured(paper(), &arrivals);
  for (std::size_t k = 400; k < 410; ++k) arrivals.commands[k].ahead = static_cast<std::int64_t>(k) - 399;
  const Measures extrapolated = measured(paper(), &arrivals);
  EXPECT_NE(extrapolated.trajectory_sha256, plain.trajectory_sha256);
  EXPECT_NEAR(extrapolated.max_position_error, plain.max_position_error, 0.06 * plain.max_position_error);
}

TEST(Arrivals, KnowOfSafeCommandsAndOfTheSafeStateThatTheyBrought) {
  auto arrivals = all_after(50'000);
  for (std::size_t k = 400; k <= 420; ++k) arrivals.commands[k].ahead = Arrival::kBlind;
  EXPECT_FALSE(measured(paper({{"limits.position_error", "1 m"}}), &arrivals).safe_at)
      << "they alone bring none";
  arrivals.interventions = {{.tick = 420, .cause = "the controller sends safe commands"}};
  const Measures measures = measured(paper({{"limits.position_error", "1 m"}}), &arrivals);
  ASSERT_TRUE(measures.safe_at);
  EXPECT_DOUBLE_EQ(*measures.safe_at, 0.42);
}

// The law has been asked all the same: what it remembers for its rate limit is that answer.
TEST(Arrivals, KnowOfSafeCommandsAfterTheLawsOwn) {
  const auto experiment = paper({{"limits.position_error", "1 m"},
                                 {"controller.safety.torque_rate_limit", "[50 N m/s, 50 N m/s, 50 N m/s]"}});
  auto arrivals = all_after(50'000);
  arrivals.commands[400].ahead = Arrival::kBlind;
  const Measures blind = measured(experiment, &arrivals);
  arrivals.commands[400].ahead = 0;
  const Measures law = measured(experiment, &arrivals);
  arrivals.commands[400].afterwards = true;
  const Measures afterwards = measured(experiment, &arrivals);
  EXPECT_NE(afterwards.trajectory_sha256, law.trajectory_sha256) << "no torque in tick 400";
  EXPECT_NE(afterwards.trajectory_sha256, blind.trajectory_sha256) << "1 ms less to catch up in";
}

TEST(Arrivals, KnowOfFaultsByMessage) {
  auto experiment = paper({{"limits.position_error", "1 m"}});
  experiment.plant.faults.injected = true;
  auto arrivals = all_after(50'000);
  const Measures well = measured(experiment, &arrivals);
  arrivals.interventions = {{.tick = 100, .fault = {.kind = Fault::Kind::off, .index = 1}}};
  EXPECT_GT(measured(experiment, &arrivals).max_position_error, 5 * well.max_position_error);
}

TEST(Arrivals, ReadBackAsTheyWereWritten) {
  const ScratchFolder folder;
  const Fault fault{.target = Fault::Target::sensor,
                    .kind = Fault::Kind::slow,
                    .index = 2,
                    .magnitude = 0.1,
                    .at = 1.0 / 3,
                    .duration = 2e-7};
  const Arrivals arrivals = {
      .commands = {{0, 17, 0, 0},
                   {1, 99'000, 1, 0},
                   {3, 5, 2, 2},
                   {3, 70, 3, Arrival::kBlind},
                   {4, 7, 4, 0, true},
                   {5, 7, 5, 3, true},
                   {6, 7, 6, Arrival::kBlind, true}},
      .interventions = {{.tick = 2, .fault = fault}, {.tick = 9, .cause = "the plant itself was suspended"}}};
  write_arrivals(folder.file("ages.csv"), arrivals);
  const auto back = read_arrivals(folder.file("ages.csv"));
  ASSERT_EQ(back.commands.size(), arrivals.commands.size());
  for (std::size_t i = 0; i < back.commands.size(); ++i) {
    EXPECT_EQ(back.commands[i].tick, arrivals.commands[i].tick);
    EXPECT_EQ(back.commands[i].offset, arrivals.commands[i].offset);
    EXPECT_EQ(back.commands[i].command, arrivals.commands[i].command);
    EXPECT_EQ(back.commands[i].ahead, arrivals.commands[i].ahead);
    EXPECT_EQ(back.commands[i].afterwards, arrivals.commands[i].afterwards);
  }
  ASSERT_EQ(back.interventions.size(), 2U);
  const Fault& again = back.interventions[0].fault;
  EXPECT_EQ(back.interventions[0].tick, 2);
  EXPECT_EQ(back.interventions[0].cause, nullptr);
  EXPECT_EQ(again.target, fault.target);
  EXPECT_EQ(again.kind, fault.kind);
  EXPECT_EQ(again.index, fault.index);
  EXPECT_EQ(again.magnitude, fault.magnitude);
  EXPECT_EQ(again.at, fault.at);
  EXPECT_EQ(again.duration, fault.duration);
  EXPECT_EQ(back.interventions[1].tick, 9);
  EXPECT_STREQ(back.interventions[1].cause, "the plant itself was suspended");
}

class BadArrivals : public testing::TestWithParam<BadInput> {};

TEST_P(BadArrivals, AreRefusedWithTheirLine) {
  const ScratchFolder folder;
  const std::string file = folder.write("ages.csv", GetParam().text);
  const auto error = input_error([&] { read_arrivals(file); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(error->message, testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadArrivals,
    testing::Values(
        BadInput{"Empty", "", "invalid_arrival", "header"},
        BadInput{"NoHeader", "0,1,0,law\n", "invalid_arrival", "header"},
        BadInput{"NoRows", "tick,offset_ns,command,how\n", "missing_entry", "no arrivals"},
        BadInput{"Words", "tick,offset_ns,command,how\na,b,c,law\n", "invalid_arrival", "a,b,c"},
        BadInput{"Short", "tick,offset_ns,command,how\n0,1,0\n", "invalid_arrival", "four fields"},
        BadInput{"How", "tick,offset_ns,command,how\n0,1,0,luck\n", "invalid_arrival", "extrapolated N"},
        BadInput{"FromTheFuture", "tick,offset_ns,command,how\n0,1,0,law\n1,1,2,law\n", "out_of_range",
                 "before"},
        BadInput{"BeforeThePath", "tick,offset_ns,command,how\n0,1,0,law\n1,1,1,extrapolated 2\n",
                 "out_of_range", "before"},
        BadInput{"Negative", "tick,offset_ns,command,how\n0,-1,0,law\n", "out_of_range", "before"},
        BadInput{"Event", "tick,offset_ns,command,how\n0,1,0,law\n3,,,law\n", "invalid_arrival", "fault"},
        BadInput{"Fault", "tick,offset_ns,command,how\n0,1,0,law\n3,,,fault: wing off 1 0 0 0\n",
                 "invalid_arrival", "TARGET"},
        BadInput{"NotFromTheStart", "tick,offset_ns,command,how\n5,1,5,law\n", "out_of_range", "command 0"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
