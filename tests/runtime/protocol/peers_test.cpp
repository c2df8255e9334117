// SPDX-License-Identifier: MIT
// Controller and planner, driven by a scripted plant.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "notation/errors.hpp"
#include "runtime/protocol/controller_peer.hpp"
#include "runtime/protocol/planner_peer.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

const PeerOptions kOptions{.n = kScriptN, .n_u = kScriptN, .config = kScriptConfig, .last_tick = 1000};

// tau = (psi_desired, tick, 0): shows which reference and which state it was made of.
ControllerSide telling_law() {
  ControllerSide side;
  side.compute = [](const state_t& state, const reference_t& r, std::int64_t, std::span<double> tau) {
    tau[0] = r.psi_desired[0];
    tau[1] = static_cast<double>(state.seq);
    return 0;
  };
  return side;
}

class Controller : public testing::Test {
 protected:
  void start(const PeerOptions& options = kOptions, ControllerSide side = telling_law()) {
    peer_.emplace(options, std::move(side));
  }
  void expect_command(std::int64_t tick, double psi) {
    const auto c = script_.next<command_t>("COMMAND");
    ASSERT_TRUE(c) << "no command for tick " << tick;
    EXPECT_EQ(c->seq, tick);
    EXPECT_EQ(c->utime, 1000 * tick);
    EXPECT_EQ(c->session, kScriptSession);
    EXPECT_EQ(c->config, kScriptConfig);
    EXPECT_EQ(c->tau_commanded[0], psi);
    EXPECT_EQ(c->tau_commanded[1], static_cast<double>(tick));
  }
  /// Sends a tick's state and reference.
  void expect_answer(std::int64_t tick, double psi) {
    script_.send_state(tick);
    script_.send_reference(tick, psi);
    expect_command(tick, psi);
  }
  /// Ends the peer and waits, after which its report may be read.
  const PeerReport& report() {
    script_.send_end();
    EXPECT_EQ(peer_->ending(), Ending::finished);
    return peer_->peer.report();
  }

  ScriptedPeer script_{"COMMAND"};
  std::optional<RunningPeer<ControllerPeer>> peer_;
};

TEST_F(Controller, AnswersWhenStateAndReferenceOfTheTickAreThere) {
  start();
  script_.send_state(0);
  EXPECT_TRUE(script_.silent("COMMAND")) << "no reference yet";
  script_.send_reference(1, 11);
  EXPECT_TRUE(script_.silent("COMMAND")) << "another tick's reference";
  script_.send_reference(0, 10);
  expect_command(0, 10);
  script_.send_state(1);
  expect_command(1, 11);
  EXPECT_EQ(report().answered, 2U);
}

TEST_F(Controller, AwaitsNoReferencesWhereThereAreNone) {
  PeerOptions options = kOptions;
  options.references = false;
  start(options);
  script_.send_reference(0, 10);  // nobody listens
  script_.send_state(0);
  expect_command(0, 0);
  script_.send_state(5);
  expect_command(5, 0);
  script_.send_state(5);
  expect_command(5, 0);
  const PeerReport& told = report();
  EXPECT_EQ(told.answered, 2U);
  EXPECT_EQ(told.rejects.total(), 0U);
}

TEST_F(Controller, RepeatsTheSameBytesForARepeatedState) {
  start();
  script_.send_state(0);
  script_.send_reference(0, 10);
  const auto first = script_.next_bytes("COMMAND");
  ASSERT_TRUE(first);
  script_.send_reference(0, 99);  // not the same bytes: the first one counts
  script_.send_state(0);
  EXPECT_EQ(script_.next_bytes("COMMAND"), first);
  EXPECT_EQ(report().repeated, 1U);
}

TEST_F(Controller, DropsAndCountsWhatIsOver) {
  start();
  expect_answer(0, 0);
  expect_answer(3, 3);
  script_.send_state(2);
  script_.send_reference(2);
  EXPECT_TRUE(script_.silent("COMMAND"));
  EXPECT_EQ(report().rejects.of(Reject::stale), 2U);
}

TEST_F(Controller, RejectsByCauseAndGoesOn) {
  start();
  expect_answer(0, 0);

  const auto spoil = [this](auto change) {
    auto s = ScriptedPeer::message<state_t>(1);
    change(s);
    script_.send("STATE", s);
  };
  spoil([](state_t& s) { s.psi_measured[1] = std::nan(""); });
  spoil([](state_t& s) { s.session = 5; });
  spoil([](state_t& s) { s.config = 5; });
  spoil([](state_t& s) { s.seq = -1; });
  spoil([](state_t& s) { s.seq = 1001; });
  spoil([](state_t& s) { s = blank<state_t>(4); });
  script_.send("STATE", ScriptedPeer::message<command_t>(1));
  script_.bus.publish(script_.bus.channel("STATE"), {});
  auto far = ScriptedPeer::message<reference_t>(900);
  script_.send("REFERENCE", far);
  script_.send_end(5);

  expect_answer(1, 1);
  // Of another session: a state and an END.
  EXPECT_EQ(to_string(report().rejects),
            "1 length, 1 fingerprint, 1 dimension, 1 not_finite, 2 session, 1 config, 3 tick");
}

TEST_F(Controller, WithAGivenSessionTakesReferencesBeforeTheFirstState) {
  PeerOptions options = kOptions;
  options.session = kScriptSession;
  start(options);
  script_.send_reference(0, 10);
  script_.send_state(0);
  expect_command(0, 10);
}

TEST_F(Controller, OfAnotherSessionThanTheGivenOneStaysSilent) {
  PeerOptions options = kOptions;
  options.session = 5;
  start(options);
  script_.send_state(0);
  script_.send_reference(0);
  EXPECT_TRUE(script_.silent("COMMAND"));
}

TEST_F(Controller, TakesANewSessionAfterASecondAndForgetsTheOldOnesTicks) {
  start();
  script_.send_state(5);
  script_.send_reference(5, 5);
  ASSERT_TRUE(script_.next<command_t>("COMMAND"));
  script_.send_reference(6, 6);

  auto state = ScriptedPeer::message<state_t>(0);
  state.session = 78;
  auto reference = ScriptedPeer::message<reference_t>(0);
  reference.session = 78;
  script_.send("STATE", state);
  EXPECT_TRUE(script_.silent("COMMAND")) << "too early";
  std::this_thread::sleep_for(1s);
  script_.send("STATE", state);
  // The reference must come after the state that made its session known: wait for the state's effect by
  // asking until it is answered.
  std::optional<command_t> c;
  for (int i = 0; i < 50 && !c; ++i) {
    script_.send("REFERENCE", reference);
    c = script_.next<command_t>("COMMAND", 20ms);
  }
  ASSERT_TRUE(c);
  EXPECT_EQ(c->session, 78);
  EXPECT_EQ(c->flags, 0);
  EXPECT_EQ(c->tau_commanded[0], 0);
}

TEST_F(Controller, ThatJoinsLateSaysSo) {
  start();
  script_.send_state(7);
  script_.send_reference(7, 1);
  const auto c = script_.next<command_t>("COMMAND");
  ASSERT_TRUE(c);
  EXPECT_EQ(c->flags, command_t::FLAG_JOINED_LATE);
  EXPECT_TRUE(report().joined_late);
}

TEST_F(Controller, WithMemoryRefusesToJoinLate) {
  ControllerSide side = telling_law();
  side.has_memory = true;
  start(kOptions, side);
  script_.send_state(7);
  EXPECT_THAT(peer_->fault(), StartsWith("joined_late: "));
}

TEST_F(Controller, RefusesAPlantThatWasStartedWithSomethingElseByName) {
  start();
  auto state = ScriptedPeer::message<state_t>(0);
  state.config ^= 1LL << 16;
  for (int i = 0; i < 3; ++i) script_.send("STATE", state);
  const std::string fault = peer_->fault();
  EXPECT_THAT(fault, StartsWith("config_mismatch: "));
  EXPECT_THAT(fault, HasSubstr("another path"));
}

TEST_F(Controller, IsNotEndedBySingleDamagedMessagesBeforeAGoodOne) {
  start();
  for (int i = 0; i < 20; ++i) {
    auto state = ScriptedPeer::message<state_t>(0);
    state.config ^= 1LL << (i / 2);
    script_.send("STATE", state);
  }
  expect_answer(0, 10);
  EXPECT_EQ(report().rejects.of(Reject::config), 20U);
}

TEST_F(Controller, DoesNotBelieveInTicksThatNoPlantReaches) {
  start();
  auto state = ScriptedPeer::message<state_t>(0);
  state.seq = std::numeric_limits<std::int64_t>::max();
  state.flags = state_t::FLAG_HOLD;
  script_.send("STATE", state);
  expect_answer(0, 10);
  EXPECT_EQ(report().rejects.of(Reject::tick), 1U);
}

TEST_F(Controller, RefusesAPlannerThatWasStartedWithSomethingElseByName) {
  PeerOptions options = kOptions;
  options.session = kScriptSession;
  start(options);
  auto reference = ScriptedPeer::message<reference_t>(0);
  reference.config ^= 1LL << 48;
  for (int i = 0; i < 3; ++i) script_.send("REFERENCE", reference);
  EXPECT_THAT(peer_->fault(), HasSubstr("another rate"));
}

TEST_F(Controller, NeverSendsATorqueThatIsNoNumber) {
  ControllerSide side;
  side.compute = [](const state_t&, const reference_t&, std::int64_t, std::span<double> tau) {
    tau[2] = std::nan("");
    return 0;
  };
  start(kOptions, side);
  script_.send_state(0);
  script_.send_reference(0);
  EXPECT_THAT(peer_->fault(), HasSubstr("tick 0"));
  EXPECT_TRUE(script_.silent("COMMAND"));
}

TEST_F(Controller, NamesThePlantWhenItIsLost) {
  PeerOptions options = kOptions;
  options.patience = 50ms;
  start(options);
  script_.send_state(0);
  const std::string fault = peer_->fault();
  EXPECT_THAT(fault, StartsWith("lost_peer: "));
  EXPECT_THAT(fault, HasSubstr("MIXLOOP_STATE for 50 ms after tick 0"));
}

TEST_F(Controller, NamesAPlantThatNeverCame) {
  PeerOptions options = kOptions;
  options.first_wait = 20ms;
  start(options);
  EXPECT_THAT(peer_->fault(), HasSubstr("nothing on MIXLOOP_STATE for 20 ms"));
}

TEST_F(Controller, NamesThePlannerWhenOnlyThatIsLost) {
  PeerOptions options = kOptions;
  options.patience = 500ms;
  start(options);
  expect_answer(0, 0);
  while (peer_->running()) {
    script_.send_state(1);
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_THAT(peer_->fault(), HasSubstr("no reference for tick 1 on MIXLOOP_REFERENCE"));
}

TEST_F(Controller, NamesTheReferencesThatItCouldNotTake) {
  PeerOptions options = kOptions;
  options.patience = 500ms;
  start(options);
  expect_answer(0, 0);
  auto reference = ScriptedPeer::message<reference_t>(1);
  reference.psid_desired[1] = NAN;
  while (peer_->running()) {
    script_.send_state(1);
    script_.send("REFERENCE", reference);
    std::this_thread::sleep_for(20ms);
  }
  const std::string fault = peer_->fault();
  EXPECT_THAT(fault, StartsWith("lost_peer: no reference for tick 1 on MIXLOOP_REFERENCE"));
  EXPECT_THAT(
      fault,
      HasSubstr(" not_finite (NaN or infinity): the planner is there, but what it sends can't be taken"));
}

TEST_F(Controller, NamesTheStatesThatItCouldNotTake) {
  PeerOptions options = kOptions;
  options.first_wait = 300ms;
  start(options);
  script_.send("STATE", ScriptedPeer::sized<state_t>(0, 4));
  const std::string fault = peer_->fault();
  EXPECT_THAT(
      fault,
      StartsWith(
          "lost_peer: nothing that can be taken on MIXLOOP_STATE for 300 ms; dropped there: 1 dimension "
          "(n is 4, expected 3)"));
}

TEST_F(Controller, RefusesByNameAPlantOfAnotherMechanismWhateverItsN) {
  start();
  auto state = ScriptedPeer::sized<state_t>(0, 4);
  state.config ^= 1LL << 32;
  for (int i = 0; i < 3; ++i) script_.send("STATE", state);
  EXPECT_THAT(peer_->fault(), HasSubstr("another mechanism than this process"));
}

TEST_F(Controller, TakesSilenceAfterTheLastTickForTheEnd) {
  PeerOptions options = kOptions;
  options.last_tick = 0;
  options.patience = 50ms;
  start(options);
  script_.send_state(0);
  script_.send_reference(0);
  EXPECT_EQ(peer_->ending(), Ending::finished);
}

TEST_F(Controller, AnswersPastTheLastTickWhereThePlantHolds) {
  PeerOptions options = kOptions;
  options.session = kScriptSession;
  options.last_tick = 3;
  start(options);
  auto state = ScriptedPeer::message<state_t>(4);
  state.flags = state_t::FLAG_HOLD;
  script_.send_reference(4, 4);
  script_.send("STATE", state);
  expect_command(4, 4);
}

TEST_F(Controller, AnswersAtTicksPast2ToThe40) {
  PeerOptions options = kOptions;
  options.session = kScriptSession;
  start(options);
  for (const std::int64_t tick : {(std::int64_t{1} << 40) + 1, (std::int64_t{1} << 40) + 2}) {
    auto state = ScriptedPeer::message<state_t>(tick);
    state.flags = state_t::FLAG_HOLD;
    script_.send("STATE", state);
    script_.send_reference(tick, 4);
    expect_command(tick, 4);
  }
}

TEST_F(Controller, HonoursAStopFromAnyoneEvenAMalformedOne) {
  start();
  script_.send_state(0);
  const std::uint8_t nonsense[] = {1, 2, 3};
  script_.bus.publish(script_.bus.channel("STOP"), nonsense);
  EXPECT_EQ(peer_->ending(), Ending::stopped);
}

TEST_F(Controller, LeavesWhenItsSwitchIsTurned) {
  start();
  peer_->stop.turn();
  EXPECT_EQ(peer_->ending(), Ending::interrupted);
}

class Planner : public testing::Test {
 protected:
  void start() {
    PlannerSide side;
    side.refer = [](std::int64_t tick, reference_t& r) { r.psi_desired[0] = static_cast<double>(tick); };
    peer_.emplace(kOptions, side);
  }
  void expect_references(std::initializer_list<std::int64_t> ticks) {
    for (const std::int64_t tick : ticks) {
      const auto r = script_.next<reference_t>("REFERENCE");
      ASSERT_TRUE(r) << tick;
      EXPECT_EQ(r->seq, tick);
      EXPECT_EQ(r->utime, 1000 * tick);
      EXPECT_EQ(r->session, kScriptSession);
      EXPECT_EQ(r->psi_desired[0], static_cast<double>(tick));
    }
    EXPECT_TRUE(script_.silent("REFERENCE"));
  }

  ScriptedPeer script_{"REFERENCE"};
  std::optional<RunningPeer<PlannerPeer>> peer_;
};

TEST_F(Planner, StaysOneTickAhead) {
  start();
  script_.send_state(0);
  expect_references({0, 1});
  script_.send_state(1);
  expect_references({2});
}

TEST_F(Planner, SendsBothForARepeatedAndForASkippedTick) {
  start();
  script_.send_state(0);
  script_.send_state(0);
  expect_references({0, 1, 0, 1});
  script_.send_state(5);
  expect_references({5, 6});
  script_.send_state(5);
  expect_references({5, 6});
  script_.send_state(4);
  expect_references({});
  script_.send_end();
  EXPECT_EQ(peer_->ending(), Ending::finished);
  EXPECT_EQ(peer_->peer.report().rejects.of(Reject::stale), 1U);
}

TEST_F(Planner, GoesOnPastTick2ToThe40ToTheMicrosecond) {
  start();
  auto state = ScriptedPeer::message<state_t>((std::int64_t{1} << 40) + 1);
  state.flags = state_t::FLAG_HOLD;
  script_.send("STATE", state);
  expect_references({state.seq, state.seq + 1});
}

TEST_F(Planner, ThatJoinsLateSendsBoth) {
  start();
  script_.send_state(8);
  expect_references({8, 9});
}

}  // namespace
}  // namespace mixloop
