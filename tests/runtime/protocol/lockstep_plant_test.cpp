// SPDX-License-Identifier: MIT
// The plant's side of lockstep, answered by a scripted controller.
#include "runtime/protocol/lockstep_plant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "notation/errors.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

/// A plant that keeps what it is told.
struct Scripted final : LockstepSide {
  bool measure(std::int64_t tick, std::span<double> psi, std::span<double>) override {
    psi[0] = static_cast<double>(tick);
    return tick == stale_at;
  }
  bool advance(std::int64_t tick, std::span<const double> tau) override {
    applied.push_back(tau[0]);
    return tick != breaks_at;
  }
  void truth(std::int64_t tick, truth_t& t) override { t.work = static_cast<double>(tick); }

  std::vector<double> applied;
  std::int64_t breaks_at = -1, stale_at = -1;
};

class Plant : public testing::Test {
 protected:
  static PlantOptions options(std::int64_t last_tick) {
    return {.n = kScriptN,
            .n_u = kScriptN,
            .last_tick = last_tick,
            .session = kScriptSession,
            .config = kScriptConfig};
  }
  void start(const PlantOptions& o) { plant_.emplace(o, side_); }

  command_t command(std::int64_t tick, double tau = 0) {
    auto c = ScriptedPeer::message<command_t>(tick);
    c.tau_commanded[0] = tau;
    return c;
  }
  /// The first STATE of a tick; repeated ones of earlier ticks are passed over.
  std::optional<state_t> first_state(std::int64_t tick) {
    std::optional<state_t> s;
    do s = script_.next<state_t>("STATE");
    while (s && s->seq < tick);
    return s;
  }
  void expect_state(std::int64_t tick) {
    const auto s = first_state(tick);
    ASSERT_TRUE(s) << "no state " << tick;
    EXPECT_EQ(s->seq, tick);
    EXPECT_EQ(s->utime, 1000 * tick);
    EXPECT_EQ(s->session, kScriptSession);
    EXPECT_EQ(s->psi_measured[0], static_cast<double>(tick));
  }
  void expect_end(std::int8_t reason, std::int64_t tick) {
    for (int i = 0; i < 2; ++i) {  // at least twice, should one get lost
      const auto end = script_.next<sim_control_t>("SIM_CONTROL");
      ASSERT_TRUE(end);
      EXPECT_EQ(end->action, sim_control_t::ACTION_END);
      EXPECT_EQ(end->reason, reason);
      EXPECT_EQ(end->seq, tick);
      EXPECT_EQ(end->session, kScriptSession);
    }
  }

  Scripted side_;
  ScriptedPeer script_{"STATE", "TRUTH", "SIM_CONTROL", "TIMING"};
  std::optional<RunningPeer<LockstepPlant>> plant_;
};

TEST_F(Plant, RunsFromTick0ToTheLastAndEndsAll) {
  start(options(2));
  for (std::int64_t k = 0; k <= 2; ++k) {
    expect_state(k);
    script_.send("COMMAND", command(k, 10.0 + static_cast<double>(k)));
  }
  EXPECT_EQ(plant_->ending(), Ending::finished);
  expect_end(sim_control_t::REASON_FINISHED, 2);
  EXPECT_EQ(side_.applied, (std::vector<double>{10, 11, 12}));
  EXPECT_EQ(plant_->peer.report().ticks_done, 3);
  EXPECT_EQ(plant_->peer.report().round_trip.count(), 2U);
  EXPECT_TRUE(script_.silent("TRUTH")) << "nobody asked for it";
}

TEST_F(Plant, RepeatsTheStateWhileNoCommandComes) {
  start(options(1));
  const auto first = script_.next_bytes("STATE");
  EXPECT_EQ(script_.next_bytes("STATE"), first);
  script_.send("COMMAND", command(0));
  expect_state(1);
  EXPECT_TRUE(script_.next_bytes("STATE")) << "STATE(1) again";
  script_.send("COMMAND", command(1));
  EXPECT_EQ(plant_->ending(), Ending::finished);
  EXPECT_GE(plant_->peer.report().resent_at_start, 1U);
  EXPECT_GE(plant_->peer.report().resent, 1U);
}

TEST_F(Plant, TakesOnlyTheCommandThatAnswersItsTick) {
  start(options(1));
  expect_state(0);
  const auto spoil = [this](std::int64_t tick, auto change) {
    auto c = command(tick, 666);
    change(c);
    script_.send("COMMAND", c);
  };
  spoil(0, [](command_t& c) { c.session = 1; });
  spoil(1, [](command_t&) {});
  spoil(-1, [](command_t&) {});
  spoil(0, [](command_t& c) { c.tau_commanded[2] = -INFINITY; });
  spoil(0, [](command_t& c) { c = blank<command_t>(2); });
  script_.send("COMMAND", ScriptedPeer::message<state_t>(0));
  script_.bus.publish(script_.bus.channel("COMMAND"), std::vector<std::uint8_t>(20));
  script_.send("COMMAND", command(0, 1));
  script_.send("COMMAND", command(0, 666));  // doubled
  expect_state(1);
  spoil(1, [](command_t& c) { c.config ^= 1; });  // too late to refuse this controller: it had agreed
  script_.send("COMMAND", command(1, 2));
  EXPECT_EQ(plant_->ending(), Ending::finished);
  EXPECT_EQ(side_.applied, (std::vector<double>{1, 2}));
  EXPECT_EQ(
      to_string(plant_->peer.report().rejects),
      "1 length, 1 fingerprint, 1 dimension, 1 not_finite, 1 session, 1 config, 1 tick, 1 stale, 1 sender");
}

TEST_F(Plant, RefusesAControllerThatWasStartedWithSomethingElseByName) {
  start(options(1));
  expect_state(0);
  auto c = command(0);
  c.config ^= 1LL << 32;
  for (int i = 0; i < 3; ++i) script_.send("COMMAND", c);
  const std::string fault = plant_->fault();
  EXPECT_THAT(fault, StartsWith("config_mismatch: "));
  EXPECT_THAT(fault, HasSubstr("MIXLOOP_COMMAND was started with another mechanism"));
  expect_end(sim_control_t::REASON_FAULT, 0);
}

TEST_F(Plant, PublishesTheTruthOfEveryTickWhenAsked) {
  PlantOptions o = options(1);
  o.truth = true;
  start(o);
  expect_state(0);
  script_.send("COMMAND", command(0));
  expect_state(1);
  script_.send("COMMAND", command(1));
  for (const std::int64_t tick : {0, 1}) {
    const auto t = script_.next<truth_t>("TRUTH");
    ASSERT_TRUE(t);
    EXPECT_EQ(t->seq, tick);
    EXPECT_EQ(t->work, static_cast<double>(tick));
  }
}

TEST_F(Plant, SaysAtWhichTickAReadingIsStale) {
  side_.stale_at = 1;
  start(options(2));
  for (std::int64_t k = 0; k <= 2; ++k) {
    const auto s = first_state(k);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->flags & state_t::FLAG_STALE, k == 1 ? state_t::FLAG_STALE : 0) << k;
    script_.send("COMMAND", command(k));
  }
  EXPECT_EQ(plant_->ending(), Ending::finished);
}

TEST_F(Plant, PublishesNothingOfTheTickThatDiverges) {
  side_.breaks_at = 1;
  start(options(9));
  expect_state(0);
  script_.send("COMMAND", command(0));
  expect_state(1);
  script_.send("COMMAND", command(1));
  EXPECT_EQ(plant_->ending(), Ending::broken_off);
  expect_end(sim_control_t::REASON_FAULT, 1);
  for (auto s = script_.next<state_t>("STATE", kScriptSilence); s;
       s = script_.next<state_t>("STATE", kScriptSilence))
    EXPECT_LE(s->seq, 1);
}

TEST_F(Plant, NamesTheChannelThatItWaitedForInVain) {
  PlantOptions o = options(1);
  o.patience = 100ms;
  start(o);
  expect_state(0);
  script_.send("COMMAND", command(0));
  const std::string fault = plant_->fault();
  EXPECT_THAT(fault, StartsWith("lost_peer: no answer to tick 1 on MIXLOOP_COMMAND for 100 ms"));
  EXPECT_THAT(fault, HasSubstr("MIXLOOP_REFERENCE is silent too"));
  expect_end(sim_control_t::REASON_FAULT, 0);
}

TEST_F(Plant, SaysThatTheControllerIsMissingWhereThePlannerAnswers) {
  PlantOptions o = options(1);
  o.first_wait = 1200ms;
  start(o);
  while (plant_->running()) {
    script_.send_reference(0);
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_THAT(plant_->fault(), HasSubstr("MIXLOOP_REFERENCE answers, so the controller is missing"));
}

TEST_F(Plant, NamesTheAnswersThatItCouldNotTake) {
  PlantOptions o = options(1);
  o.patience = 300ms;
  start(o);
  expect_state(0);
  script_.send("COMMAND", command(0));
  expect_state(1);
  const auto spoil = [this](int times, auto change) {
    auto c = command(1);
    change(c);
    for (int i = 0; i < times; ++i) script_.send("COMMAND", c);
  };
  spoil(60, [](command_t& c) { c.tau_commanded[1] = NAN; });
  spoil(4, [](command_t& c) { c = ScriptedPeer::sized<command_t>(1, 2); });
  spoil(2, [](command_t& c) { c.session = 5; });
  spoil(1, [](command_t& c) { c.config ^= 1; });
  spoil(1, [](command_t& c) { c.seq = 9; });
  const std::string fault = plant_->fault();
  EXPECT_THAT(fault,
              StartsWith("lost_peer: no answer to tick 1 on MIXLOOP_COMMAND for 300 ms; dropped there: "));
  EXPECT_THAT(fault, HasSubstr("4 dimension (n is 2, expected 3), 60 not_finite (NaN or infinity), "
                               "2 session (5, expected 77), 1 config (another shared parameters), "
                               "1 tick (9, which can't be; expected 1)"));
  EXPECT_THAT(fault, HasSubstr("the controller is there, but what it answers can't be taken"));
  expect_end(sim_control_t::REASON_FAULT, 0);
}

TEST_F(Plant, SaysByTimingWhatItDropsWhileItWaits) {
  start(options(1));
  expect_state(0);
  auto c = command(0);
  c.tau_commanded[1] = NAN;
  script_.send("COMMAND", c);
  std::optional<timing_t> timing;
  do timing = script_.next<timing_t>("TIMING");
  while (timing && timing->rejected_not_finite == 0);
  ASSERT_TRUE(timing);
  EXPECT_EQ(timing->rejected_not_finite, 1);
}

TEST_F(Plant, RefusesByNameAControllerThatComesToDifferLater) {
  PlantOptions o = options(5);
  o.config_words = {"1000 Hz", "robot.yaml", "a line", "payload = 5"};
  start(o);
  expect_state(0);
  script_.send("COMMAND", command(0));
  expect_state(1);
  auto other = command(1);
  other.config ^= 1LL << 48;
  std::vector<double>(2).swap(other.tau_commanded);  // and of another mechanism's n
  other.n = 2;
  other.config ^= 1LL << 32;
  while (plant_->running()) {
    script_.send("COMMAND", other);
    std::this_thread::sleep_for(20ms);
  }
  const std::string fault = plant_->fault();
  EXPECT_THAT(fault, StartsWith("config_mismatch: "));
  EXPECT_THAT(fault,
              HasSubstr("another rate and mechanism than this plant: rate is 1000 Hz here (hash 0001), "
                        "there another (hash 0000); mechanism is robot.yaml here"));
}

TEST_F(Plant, IsNotEndedByAnotherControllerWhileTheRightOneAnswers) {
  start(options(30));
  auto other = command(0);
  other.config ^= 1;
  for (std::int64_t k = 0; k <= 30; ++k) {
    expect_state(k);
    script_.send("COMMAND", command(k));
    for (int i = 0; i < 3; ++i) script_.send("COMMAND", other);
  }
  EXPECT_EQ(plant_->ending(), Ending::finished);
}

TEST_F(Plant, HonoursAStopFromAnyoneEvenAMalformedOne) {
  start(options(9));
  expect_state(0);
  script_.bus.publish(script_.bus.channel("STOP"), {});
  EXPECT_EQ(plant_->ending(), Ending::stopped);
  expect_end(sim_control_t::REASON_STOPPED, 0);
}

TEST_F(Plant, EndsAllWhenInterrupted) {
  start(options(9));
  expect_state(0);
  plant_->stop.turn();
  EXPECT_EQ(plant_->ending(), Ending::interrupted);
  expect_end(sim_control_t::REASON_INTERRUPTED, 0);
}

TEST_F(Plant, ThatHoldsGoesOnPastTheLastTickAndHasFinishedWhenStopped) {
  PlantOptions o = options(0);
  o.hold = true;
  start(o);
  for (std::int64_t k = 0; k < 3; ++k) {
    const auto s = first_state(k);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->flags, state_t::FLAG_HOLD);
    script_.send("COMMAND", command(k));
  }
  plant_->stop.turn();
  EXPECT_EQ(plant_->ending(), Ending::finished);
}

TEST_F(Plant, KeepsToThePaceThatItIsGiven) {
  PlantOptions o = options(20);
  o.speed = 1;
  plant_.emplace(o, side_);
  Instant first{0}, last{0};
  for (std::int64_t k = 0; k <= 20; ++k) {
    ASSERT_TRUE(first_state(k));
    (k == 0 ? first : last) = now();
    script_.send("COMMAND", command(k));
  }
  EXPECT_GE(last - first, 20ms) << "20 ticks of 1 ms from the first command on, which comes after `first`";
  EXPECT_EQ(plant_->ending(), Ending::finished);
}

}  // namespace
}  // namespace mixloop
