// SPDX-License-Identifier: MIT
// The plant's side of real time, answered by a scripted controller. Slow ticks (40 ms), so that a busy
// machine changes nothing.
#include "runtime/protocol/real_time_plant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "notation/errors.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct Taken {
  std::int64_t tick, in_tick, offset;
  double tau;
};

/// A plant that keeps what it is told.
struct Scripted final : RealTimeSide {
  bool measure(std::int64_t tick, std::span<double> psi, std::span<double>) override {
    psi[0] = static_cast<double>(tick);
    return false;
  }
  void truth(std::int64_t, truth_t&) override {}
  void command(const command_t& c, std::int64_t offset) override {
    taken.push_back({c.seq, done, offset, c.tau_commanded[0]});
  }
  bool finish_tick(std::int64_t tick) override {
    done = tick + 1;
    return tick != breaks_at;
  }
  void make_safe(const char* cause) override { safe = cause; }
  bool is_safe() const override { return !safe.empty(); }
  DeadlineCounts deadlines() const override {
    return {.missed = 3, .longest_miss = 2, .success_last_100 = 0.97};
  }

  std::vector<Taken> taken;
  std::atomic<std::int64_t> done = 0;  // also read while the plant runs
  std::int64_t breaks_at = -1;
  std::string safe;
};

class RealTime : public testing::Test {
 protected:
  static PlantOptions options(std::int64_t last_tick) {
    return {.n = kScriptN,
            .n_u = kScriptN,
            .last_tick = last_tick,
            .rate_hz = 25,
            .speed = 1,
            .session = kScriptSession,
            .config = kScriptConfig,
            .max_missed = 5};
  }
  void start(const PlantOptions& o) { plant_.emplace(o, side_); }

  void send_command(std::int64_t tick, double tau = 0, std::int32_t flags = 0) {
    auto c = ScriptedPeer::message<command_t>(tick);
    c.tau_commanded[0] = tau;
    c.flags = flags;
    script_.send("COMMAND", c);
  }
  void send_control(std::int8_t action, std::int64_t seq = 0) {
    auto control = ScriptedPeer::message<sim_control_t>(0);
    control.seq = seq;
    control.action = action;
    script_.send("SIM_CONTROL", control);
  }
  state_t state(std::int64_t tick) {
    std::optional<state_t> s;
    do s = script_.next<state_t>("STATE");
    while (s && s->seq < tick);
    EXPECT_TRUE(s && s->seq == tick) << "no state " << tick;
    return s.value_or(blank<state_t>(kScriptN));
  }

  Scripted side_;
  ScriptedPeer script_{"STATE", "SIM_CONTROL", "TIMING"};
  std::optional<RunningPeer<RealTimePlant>> plant_;
};

TEST_F(RealTime, WaitsForTheFirstCommandAndForNoOther) {
  start(options(8));
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(state(0).flags, state_t::FLAG_REAL_TIME);
  EXPECT_EQ(side_.done, 0);
  const Instant began = now();
  send_command(0, 1);
  EXPECT_EQ(plant_->ending(), Ending::finished);
  EXPECT_GE(now() - began, 320ms) << "9 ticks of 40 ms, the first one begun";
  EXPECT_EQ(side_.done, 9);
  ASSERT_EQ(side_.taken.size(), 1U);
  EXPECT_EQ(side_.taken[0].tick, 0);
  EXPECT_EQ(plant_->peer.report().wake_up.count(), 9U);
}

TEST_F(RealTime, SaysWhenInItsTickACommandArrived) {
  start(options(3));
  state(0);
  send_command(0, 1);
  state(1);
  std::this_thread::sleep_for(3ms);
  send_command(1, 2);
  state(2);
  send_command(2, 3);
  state(3);
  send_command(3, 4);
  EXPECT_EQ(plant_->ending(), Ending::finished);
  ASSERT_EQ(side_.taken.size(), 4U);
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(side_.taken[k].tick, static_cast<std::int64_t>(k));
    EXPECT_EQ(side_.taken[k].in_tick, side_.taken[k].tick);
    EXPECT_EQ(side_.taken[k].tau, static_cast<double>(k + 1));
    EXPECT_LT(side_.taken[k].offset, 40'000'000);
  }
  EXPECT_GE(side_.taken[1].offset, 3'000'000);
  EXPECT_EQ(plant_->peer.report().round_trip.count(), 3U);
}

TEST_F(RealTime, CountsOffsetsInPlantTime) {
  PlantOptions o = options(1);
  o.speed = 0.5;
  start(o);
  state(0);
  send_command(0);
  state(1);
  std::this_thread::sleep_for(4ms);
  send_command(1);
  EXPECT_EQ(plant_->ending(), Ending::finished);
  ASSERT_EQ(side_.taken.size(), 2U);
  EXPECT_GE(side_.taken[1].offset, 2'000'000) << "4 ms of real time";
}

TEST_F(RealTime, TakesALateCommandUnlessANewerOneCameOrItIsTooOld) {
  start(options(12));
  state(0);
  send_command(0);
  state(2);
  send_command(1, 10);  // a tick late
  send_command(2, 20);
  state(3);
  send_command(1, 30);  // older than what is in effect
  send_command(3, 40);
  send_command(3, 40);  // doubled
  send_command(9, 60);  // of a tick to come
  state(12);
  send_command(4, 70);  // 8 ticks late, 5 are forgiven
  EXPECT_EQ(plant_->ending(), Ending::finished);
  std::vector<double> torques;
  for (const Taken& t : side_.taken) torques.push_back(t.tau);
  EXPECT_EQ(torques, (std::vector<double>{0, 10, 20, 40}));
  EXPECT_EQ(plant_->peer.report().rejects.of(Reject::stale), 3U);
  EXPECT_EQ(plant_->peer.report().rejects.of(Reject::tick), 1U);
}

TEST_F(RealTime, GoesIntoItsSafeStateWhereTheControllerKeepsSendingSafeCommands) {
  start(options(8));
  for (std::int64_t k = 0; k <= 8; ++k) {
    const bool safe = (state(k).flags & state_t::FLAG_SAFE_STATE) != 0;
    EXPECT_EQ(safe, k > 5) << k;  // the sixth in a row brings it
    send_command(k, 0, command_t::FLAG_SAFE);
  }
  EXPECT_EQ(plant_->ending(), Ending::finished);
  EXPECT_THAT(side_.safe, HasSubstr("controller"));
}

TEST_F(RealTime, IsPausedAndSteppedAndGoesOn) {
  PlantOptions o = options(6);
  o.paused = true;
  start(o);
  state(0);
  send_command(0);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(side_.done, 1) << "tick 0 itself is lived through";
  send_control(sim_control_t::ACTION_STEP, 2);
  state(2);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(side_.done, 3);
  send_control(sim_control_t::ACTION_RESUME);
  EXPECT_EQ(plant_->ending(), Ending::finished);
  EXPECT_EQ(side_.done, 7);
  EXPECT_EQ(side_.safe, "") << "a pause is no suspension";
  EXPECT_LT(plant_->peer.report().slipped, 500ms) << "a pause is no slip: they took 600 ms";
}

// Its controller's answer to the last tick before a pause was late; what it sends while nobody waits isn't
// taken.
TEST_F(RealTime, TakesACommandThatComesInAPauseIntoTheNextTick) {
  PlantOptions o = options(2);
  o.paused = true;
  start(o);
  state(0);
  send_command(0);
  send_control(sim_control_t::ACTION_STEP, 1);
  ASSERT_TRUE(eventually([&] { return side_.done == 2; }));  // and COMMAND(1) has not come
  std::this_thread::sleep_for(20ms);
  send_command(1, 10);
  send_command(1, 20, std::int32_t{command_t::FLAG_SAFE} + command_t::FLAG_AFTERWARDS);
  std::this_thread::sleep_for(20ms);
  send_control(sim_control_t::ACTION_RESUME);
  EXPECT_EQ(plant_->ending(), Ending::finished);
  ASSERT_EQ(side_.taken.size(), 2U);
  EXPECT_EQ(side_.taken[1].in_tick, 2);
  EXPECT_EQ(side_.taken[1].tau, 10);
  EXPECT_EQ(plant_->peer.report().rejects.of(Reject::stale), 1U);
}

TEST_F(RealTime, IsResetByTheOperatorAndTellsWhichSessionComesNext) {
  start(options(1000));
  state(0);
  send_command(0);
  state(3);
  send_control(sim_control_t::ACTION_RESET);
  EXPECT_EQ(plant_->ending(), Ending::reset);
  plant_->peer.send_reset(4711);
  for (;;) {
    const auto control = script_.next<sim_control_t>("SIM_CONTROL");
    ASSERT_TRUE(control);
    EXPECT_EQ(control->action, sim_control_t::ACTION_RESET);
    if (control->seq == 4711) break;
  }
}

TEST_F(RealTime, PublishesItsTiming) {
  start(options(20));
  state(0);
  send_command(0);
  for (std::int64_t k = 1; k <= 12; ++k) {
    state(k);
    send_command(k);
  }
  const auto timing = script_.next<timing_t>("TIMING");
  ASSERT_TRUE(timing);
  EXPECT_EQ(timing->missed, 3);
  EXPECT_EQ(timing->longest_miss, 2);
  EXPECT_EQ(timing->success_last_100, 0.97);
  const auto later = script_.next<timing_t>("TIMING");
  ASSERT_TRUE(later);
  EXPECT_GT(later->round_trip_p50, 0);
  EXPECT_GT(later->wake_up_max, 0);
}

TEST_F(RealTime, BreaksOffWhereThePlantSaysSo) {
  side_.breaks_at = 2;
  start(options(10));
  state(0);
  send_command(0);
  EXPECT_EQ(plant_->ending(), Ending::broken_off);
  EXPECT_EQ(plant_->peer.report().ticks_done, 2);
}

TEST_F(RealTime, HasNoSpeedMax) {
  Bus bus;
  const StopSwitch stop;
  PlantOptions o = options(1);
  o.speed = 0;
  EXPECT_THROW(RealTimePlant(bus, stop, o, side_), InputError);
}

}  // namespace
}  // namespace mixloop
