// SPDX-License-Identifier: MIT
#include "loop/arrivals.hpp"

#include <gmock/gmock.h>

#include "loop/simulate.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

Experiment paper(const std::vector<Override>& overrides = {}) {
  return load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"), overrides);
}

Measures measured(const Experiment& experiment, const std::vector<Arrival>* arrivals) {
  const Plan plan = make_plan(experiment);
  Recorder recorder(experiment, plan);
  const auto go_on = [](std::int64_t) { return true; };
  if (arrivals)
    simulate_arrivals(experiment, plan, *arrivals, recorder, go_on);
  else
    simulate(experiment, plan, recorder, go_on);
  return recorder.measures();
}

std::vector<Arrival> all_after(std::int64_t offset, std::int64_t ticks = 1000) {
  std::vector<Arrival> arrivals;
  for (std::int64_t k = 0; k <= ticks; ++k) arrivals.push_back({k, k == 0 ? 0 : offset, k});
  return arrivals;
}

TEST(Arrivals, at_once_are_lockstep_to_the_bit) {
  const auto arrivals = all_after(0);
  EXPECT_EQ(measured(paper(), &arrivals).trajectory_sha256, measured(paper(), nullptr).trajectory_sha256);
}

// The tick is split at the same place; only 1e-9 * 400000 and 0.4 / 1000 may round apart, by 5e-20 s.
TEST(Arrivals, after_a_fixed_time_are_a_command_delay) {
  const auto arrivals = all_after(400'000);
  const Measures late = measured(paper(), &arrivals);
  const Measures delayed = measured(paper({{"plant.command_delay", "400 us"}}), nullptr);
  EXPECT_NEAR(late.max_position_error, delayed.max_position_error, 1e-12);
  EXPECT_NEAR(late.final_position_error, delayed.final_position_error, 1e-12);
}

TEST(Arrivals, and_a_command_delay_add_up) {
  const auto arrivals = all_after(150'000);
  const Measures both = measured(paper({{"plant.command_delay", "250 us"}}), &arrivals);
  const Measures delayed = measured(paper({{"plant.command_delay", "400 us"}}), nullptr);
  EXPECT_NEAR(both.max_position_error, delayed.max_position_error, 1e-12);
}

TEST(Arrivals, that_stop_bring_the_safe_state) {
  auto arrivals = all_after(50'000);
  arrivals.resize(300);  // command 299 is the last
  const Measures measures = measured(paper({{"real_time.max_missed", "20"}}), &arrivals);
  ASSERT_TRUE(measures.safe_at);
  EXPECT_DOUBLE_EQ(*measures.safe_at, 0.321) << "ticks 300 to 320 are 21 misses";
  EXPECT_EQ(measures.ticks, 1000);
  EXPECT_FALSE(measures.diverged_at);
}

TEST(Arrivals, read_back_as_they_were_written) {
  const ScratchFolder folder;
  const std::vector<Arrival> arrivals = {{0, 17, 0}, {1, 99'000, 1}, {3, 5, 2}, {3, 70, 3}};
  write_arrivals(folder.file("ages.csv"), arrivals);
  const auto back = read_arrivals(folder.file("ages.csv"));
  ASSERT_EQ(back.size(), arrivals.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].tick, arrivals[i].tick);
    EXPECT_EQ(back[i].offset, arrivals[i].offset);
    EXPECT_EQ(back[i].command, arrivals[i].command);
  }
}

class BadArrivals : public testing::TestWithParam<BadInput> {};

TEST_P(BadArrivals, are_refused_with_their_line) {
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
        BadInput{"NoHeader", "0,1,0\n", "invalid_arrival", "header"},
        BadInput{"NoRows", "tick,offset_ns,command\n", "missing_entry", "no arrivals"},
        BadInput{"Words", "tick,offset_ns,command\na,b,c\n", "invalid_arrival", "a,b,c"},
        BadInput{"Rest", "tick,offset_ns,command\n0,1,0,9\n", "invalid_arrival", "0,1,0,9"},
        BadInput{"FromTheFuture", "tick,offset_ns,command\n0,1,0\n1,1,2\n", "out_of_range", "before"},
        BadInput{"Negative", "tick,offset_ns,command\n0,-1,0\n", "out_of_range", "before"},
        BadInput{"NotFromTheStart", "tick,offset_ns,command\n5,1,5\n", "out_of_range", "command 0"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
