// SPDX-License-Identifier: MIT
// A bus without authentication: what comes in a session's name, but from somewhere else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/protocol/controller_peer.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Received from(std::uint16_t port, std::vector<std::uint8_t>& bytes) {
  return {.sender = {.address = 0x7f000001, .port = port}, .channel = "C", .data = bytes};
}

TEST(SoleSender, IsTheFirstUntilASecondOfSilence) {
  std::vector<std::uint8_t> a{1}, b{2};
  SoleSender sender;
  EXPECT_TRUE(sender.admits(from(1, a).sender, 5s));
  sender.take(from(1, a), 5s);
  EXPECT_TRUE(sender.admits(from(1, a).sender, 100s));
  EXPECT_FALSE(sender.admits(from(2, b).sender, 6s));
  EXPECT_TRUE(sender.admits(from(2, b).sender, 6s + 1ns));
  sender.take(from(2, b), 7s);
  EXPECT_FALSE(sender.admits(from(1, a).sender, 7s)) << "the other one has its place now";
}

TEST(SoleSender, IsARivalsOnlyWhereBothAreThere) {
  std::vector<std::uint8_t> a{1}, b{2};
  SoleSender sender;
  sender.take(from(1, a), 5s);
  sender.refuse(from(2, b).sender, 7);  // perhaps in the place of one that was killed
  EXPECT_THAT(describe(sender.rival(), "C"), IsEmpty());
  sender.take(from(1, a), 5s);
  EXPECT_EQ(describe(sender.rival(), "C"),
            "a second sender on C: 1 messages from 127.0.0.1:2 were not taken, the first of tick 7; "
            "127.0.0.1:1 goes on being heard");
}

TEST(SoleSender, DoesNotContradictItself) {
  std::vector<std::uint8_t> a{1}, b{2};
  SoleSender sender;
  sender.take(from(1, a), 5s);
  EXPECT_FALSE(sender.contradicts(from(1, a), 3));
  EXPECT_TRUE(sender.contradicts(from(1, b), 3));
  EXPECT_THAT(describe(sender.rival(), "C"),
              HasSubstr("of tick 3 came something else than what 127.0.0.1:1"));
}

/// What a peer or a plant tells of; read after it has ended.
class SecondSender : public testing::Test {
 protected:
  std::function<void(const std::string&)> notice() {
    return [this](const std::string& text) { told_.push_back(text); };
  }
  void start_controller() {
    ControllerSide side;
    side.compute = [](const state_t& state, const reference_t& r, std::int64_t, std::span<double> tau) {
      tau[0] = r.psi_desired[0];
      tau[1] = state.psi_measured[0];
      return 0;
    };
    controller_.emplace(PeerOptions{.n = kScriptN,
                                    .n_u = kScriptN,
                                    .config = kScriptConfig,
                                    .last_tick = 100'000,
                                    .notice = notice()},
                        std::move(side));
  }
  void expect_answer(std::int64_t tick) {
    script_.send_state(tick);
    script_.send_reference(tick, static_cast<double>(tick));
    expect_command(tick);
  }
  void expect_command(std::int64_t tick) {
    const auto command = script_.next<command_t>("COMMAND");
    ASSERT_TRUE(command) << "no command for tick " << tick;
    EXPECT_EQ(command->seq, tick);
    EXPECT_EQ(command->tau_commanded[0], static_cast<double>(tick)) << "another's reference";
    EXPECT_EQ(command->tau_commanded[1], 0) << "another's state";
  }
  void end() {
    script_.send_end();
    EXPECT_EQ(controller_->ending(), Ending::finished);
  }
  const Rejects& rejects() { return controller_->peer.report().rejects; }

  ScriptedPeer script_{"COMMAND"};
  ScriptedPeer stranger_{};
  std::vector<std::string> told_;
  std::optional<RunningPeer<ControllerPeer>> controller_;
};

TEST_F(SecondSender, OfAFarStateEndsNothing) {
  start_controller();
  expect_answer(0);
  stranger_.send_state(5000);
  for (std::int64_t k = 1; k < 5; ++k) expect_answer(k);
  end();
  EXPECT_EQ(to_string(rejects()), "1 sender");
  EXPECT_THAT(told_, ElementsAre(HasSubstr("a second sender on MIXLOOP_STATE: 1 messages from port ")));
}

TEST_F(SecondSender, OfTheNextStateIsNotAnswered) {
  start_controller();
  expect_answer(0);
  auto forged = ScriptedPeer::message<state_t>(1);
  forged.psi_measured[0] = 666;
  stranger_.send("STATE", forged);
  expect_answer(1);
  end();
  EXPECT_EQ(to_string(rejects()), "1 sender");
}

// By the plant's own address, as who may open raw sockets could: its next true message shows it.
TEST_F(SecondSender, ThatClaimsToBeTheFirstIsSeenByTheBytes) {
  start_controller();
  expect_answer(0);
  auto forged = ScriptedPeer::message<state_t>(0);
  forged.psi_measured[0] = 666;
  script_.send("STATE", forged);
  expect_answer(1);
  end();
  EXPECT_EQ(to_string(rejects()), "1 sender");
  EXPECT_THAT(told_, ElementsAre(HasSubstr("of tick 0 came something else")));
}

TEST_F(SecondSender, OfAResetOrAnEndDoesNotScatterThePeers) {
  start_controller();
  expect_answer(0);
  auto reset = ScriptedPeer::message<sim_control_t>(4711);
  reset.action = sim_control_t::ACTION_RESET;
  stranger_.send("SIM_CONTROL", reset);
  stranger_.send_end();
  for (std::int64_t k = 1; k < 5; ++k) expect_answer(k);
  end();
  EXPECT_EQ(to_string(rejects()), "2 sender");
}

TEST_F(SecondSender, OfAReferenceIsNotTaken) {
  start_controller();
  expect_answer(0);
  stranger_.send_reference(1, 666);
  script_.send_reference(1, 1);
  script_.send_state(1);
  expect_command(1);
  script_.send_reference(2, 2);
  script_.send_reference(2, 666);
  script_.send_state(2);
  expect_command(2);
  end();
  EXPECT_EQ(to_string(rejects()), "2 sender");
  EXPECT_THAT(told_, ElementsAre(HasSubstr("a second sender on MIXLOOP_REFERENCE")));
}

// What is nobody's puts nothing off.
TEST_F(SecondSender, OfGarbageDoesNotHideThatThePlantIsLost) {
  ControllerSide side;
  side.compute = [](const state_t&, const reference_t&, std::int64_t, std::span<double>) { return 0; };
  controller_.emplace(PeerOptions{.n = kScriptN, .n_u = kScriptN, .first_wait = 100ms, .patience = 100ms},
                      std::move(side));
  const std::vector<std::uint8_t> garbage(50);
  for (const Instant end = now() + 10s; controller_->running() && now() < end;)
    stranger_.bus.publish(stranger_.bus.channel("STATE"), garbage);
  EXPECT_FALSE(controller_->running());
  EXPECT_THAT(controller_->fault(), HasSubstr("nothing that can be taken on MIXLOOP_STATE for 100 ms"));
}

struct AppliedSide final : LockstepSide {
  bool measure(std::int64_t, std::span<double>, std::span<double>) override { return false; }
  bool advance(std::int64_t, std::span<const double> tau) override {
    applied.push_back(tau[0]);
    return true;
  }
  void truth(std::int64_t, truth_t&) override {}
  std::vector<double> applied;
};

TEST_F(SecondSender, OfACommandDoesNotMoveThePlant) {
  ScriptedPeer controller{"STATE"};
  AppliedSide side;
  RunningPeer<LockstepPlant> plant(PlantOptions{.n = kScriptN,
                                                .n_u = kScriptN,
                                                .last_tick = 3,
                                                .session = kScriptSession,
                                                .config = kScriptConfig,
                                                .notice = notice()},
                                   side);
  for (std::int64_t k = 0; k <= 3; ++k) {
    std::optional<state_t> state;
    do state = controller.next<state_t>("STATE");
    while (state && state->seq < k);
    ASSERT_TRUE(state);
    auto command = ScriptedPeer::message<command_t>(k);
    command.tau_commanded[0] = 666;
    if (k > 0) stranger_.send("COMMAND", command);
    command.tau_commanded[0] = 1;
    controller.send("COMMAND", command);
  }
  EXPECT_EQ(plant.ending(), Ending::finished);
  EXPECT_THAT(side.applied, ElementsAre(1, 1, 1, 1));
  EXPECT_EQ(plant.peer.report().rejects.of(Reject::sender), 3U);
  EXPECT_EQ(plant.peer.report().rival.messages, 3U);
  EXPECT_THAT(told_, ElementsAre(HasSubstr("a second sender on MIXLOOP_COMMAND")));
}

TEST_F(SecondSender, OfStatesIsAnotherPlantOfWhichThePlantTells) {
  AppliedSide side;
  RunningPeer<LockstepPlant> plant(PlantOptions{.n = kScriptN,
                                                .n_u = kScriptN,
                                                .last_tick = 3,
                                                .config = kScriptConfig,
                                                .first_wait = 500ms,
                                                .notice = notice()},
                                   side);
  ScriptedPeer ear{"STATE"};
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(ear.next_bytes("STATE")) << "the plant waits";
  for (int i = 0; i < 3; ++i) script_.send_state(40 + i);
  EXPECT_THAT(plant.fault(), HasSubstr("another plant is on MIXLOOP_STATE: session 77 from port "));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("give one of them another --channel-prefix")));
}

}  // namespace
}  // namespace mixloop
