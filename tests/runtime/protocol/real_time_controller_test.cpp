// SPDX-License-Identifier: MIT
// The controller's side of real time, before a scripted plant and planner.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/protocol/controller_peer.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;

/// Ticks of 20 ms, so that a busy machine changes nothing. tau = (psi_desired, tick, ahead), safe: (-1, -1,
/// -1).
class RealTimeController : public testing::Test {
 protected:
  RealTimeController() {
    ControllerSide side;
    side.compute = [](const state_t& state, const reference_t& r, std::int64_t ahead, std::span<double> tau) {
      tau[0] = r.psi_desired[0];
      tau[1] = static_cast<double>(state.seq);
      tau[2] = static_cast<double>(ahead);
      return 0;
    };
    side.safe = [](std::span<double> tau) { std::fill(tau.begin(), tau.end(), -1.0); };
    peer_.emplace(PeerOptions{.n = kScriptN,
                              .n_u = kScriptN,
                              .session = kScriptSession,
                              .config = kScriptConfig,
                              .rate_hz = 50,
                              .last_tick = 1000,
                              .max_missed = 5},
                  side);
  }
  void send_state(std::int64_t tick) {
    auto state = ScriptedPeer::message<state_t>(tick);
    state.flags = state_t::FLAG_REAL_TIME;
    script_.send("STATE", state);
  }
  command_t command(std::int64_t tick) {
    const auto c = script_.next<command_t>("COMMAND");
    EXPECT_TRUE(c) << "no command for tick " << tick;
    if (!c) return blank<command_t>(kScriptN);
    EXPECT_EQ(c->seq, tick);
    return *c;
  }

  ScriptedPeer script_{"COMMAND"};
  std::optional<RunningPeer<ControllerPeer>> peer_;
};

TEST_F(RealTimeController, AnswersAsInLockstepWhereAllIsThere) {
  script_.send_reference(0, 5);
  send_state(0);
  const command_t c = command(0);
  EXPECT_EQ(c.tau_commanded[0], 5);
  EXPECT_EQ(c.flags, 0);
}

TEST_F(RealTimeController, WaitsAtTick0ForItsReference) {
  send_state(0);
  EXPECT_FALSE(script_.next<command_t>("COMMAND", 200ms)) << "10 ticks";
  script_.send_reference(0, 5);
  EXPECT_EQ(command(0).tau_commanded[0], 5);
}

TEST_F(RealTimeController, HasAMissingReferenceExtrapolatedForSomeTicks) {
  script_.send_reference(0, 5);
  send_state(0);
  command(0);
  for (const std::int64_t tick : {1, 5}) {
    send_state(tick);
    const command_t c = command(tick);
    EXPECT_NE(c.flags & command_t::FLAG_EXTRAPOLATED, 0);
    EXPECT_EQ(extrapolated_by(c.flags), tick);
    EXPECT_EQ(c.tau_commanded[0], 5);
    EXPECT_EQ(c.tau_commanded[2], static_cast<double>(tick));
  }
  send_state(6);  // one tick more than is forgiven
  const command_t far = command(6);
  EXPECT_EQ(far.flags, std::int32_t{command_t::FLAG_SAFE} + command_t::FLAG_WITHOUT_REFERENCE);
  EXPECT_EQ(extrapolated_by(far.flags), 0);
  EXPECT_EQ(far.tau_commanded[0], -1);
  script_.send_reference(7, 8);
  send_state(7);
  const command_t again = command(7);
  EXPECT_EQ(again.flags, 0) << "back with the planner";
  EXPECT_EQ(again.tau_commanded[0], 8);
}

TEST_F(RealTimeController, SendsOneSafeCommandWhereThePlantFallsSilent) {
  script_.send_reference(0, 5);
  send_state(0);
  const command_t own = command(0);
  const Instant quiet = now();
  const command_t c = command(0);
  EXPECT_EQ(c.flags, std::int32_t{command_t::FLAG_SAFE} + command_t::FLAG_AFTERWARDS);
  EXPECT_EQ(c.tau_commanded[0], -1);
  EXPECT_GE(now() - quiet, 80ms) << "5 ticks of 20 ms, less what went before";
  EXPECT_FALSE(script_.next<command_t>("COMMAND", 200ms)) << "once";
  send_state(0);  // a plant that is paused
  const command_t again = command(0);
  EXPECT_EQ(again.tau_commanded, own.tau_commanded) << "its own answer, by which it is lived through again";
  EXPECT_EQ(again.flags, own.flags);
}

TEST_F(RealTimeController, SendsASafeCommandOnStopAndLeaves) {
  script_.send_reference(0, 5);
  send_state(0);
  command(0);
  script_.send("STOP", ScriptedPeer::message<stop_t>(0));
  EXPECT_EQ(command(0).flags,
            std::int32_t{command_t::FLAG_SAFE} + command_t::FLAG_STOPPED + command_t::FLAG_AFTERWARDS);
  EXPECT_EQ(peer_->ending(), Ending::stopped);
}

TEST_F(RealTimeController, FollowsThePlantIntoItsNextSession) {
  script_.send_reference(0, 5);
  send_state(0);
  command(0);
  auto reset = ScriptedPeer::message<sim_control_t>(0);
  reset.action = sim_control_t::ACTION_RESET;
  reset.seq = 4711;
  script_.send("SIM_CONTROL", reset);
  auto state = ScriptedPeer::message<state_t>(0);
  state.session = 4711;
  state.flags = state_t::FLAG_REAL_TIME;
  auto reference = ScriptedPeer::message<reference_t>(0);
  reference.session = 4711;
  reference.psi_desired[0] = 9;
  script_.send("REFERENCE", reference);
  script_.send("STATE", state);
  const auto c = script_.next<command_t>("COMMAND");
  ASSERT_TRUE(c);
  EXPECT_EQ(c->session, 4711);
  EXPECT_EQ(c->tau_commanded[0], 9);
}

}  // namespace
}  // namespace mixloop
