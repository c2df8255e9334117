// SPDX-License-Identifier: MIT
// On the bus, where a plant measures more coordinates than motors drive: STATE counts the ones, COMMAND and
// REFERENCE the others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/protocol/controller_peer.hpp"
#include "runtime/protocol/lockstep_plant.hpp"
#include "runtime/protocol/planner_peer.hpp"
#include "tests/runtime/protocol/scripted_peer.hpp"

namespace mixloop {
namespace {

constexpr int kCoordinates = kScriptN, kMotors = 2;

template <class Message>
Message of_motors(std::int64_t tick, int n = kMotors) {
  Message m = blank<Message>(n);
  Header header = header_of(ScriptedPeer::message<Message>(tick));
  header.n = n;
  set_header(m, header);
  return m;
}

/// The next message of motors on a channel.
template <class Message>
std::optional<Message> next(ScriptedPeer& script, const char* channel) {
  const auto bytes = script.next_bytes(channel);
  Inbox<Message> inbox(kMotors);
  if (!bytes || inbox.read(*bytes)) return std::nullopt;
  return inbox.message;
}

struct Sizes final : LockstepSide {
  std::atomic<std::size_t> measured = 0, commanded = 0;

  bool measure(std::int64_t, std::span<double> psi, std::span<double>) override {
    measured = psi.size();
    return false;
  }
  bool advance(std::int64_t, std::span<const double> tau) override {
    commanded = tau.size();
    return true;
  }
  void truth(std::int64_t, truth_t&) override {}
};

TEST(FewerMotors, ThePlantTakesTheirCommandsAlone) {
  ScriptedPeer script{"STATE"};
  Sizes side;
  RunningPeer<LockstepPlant> plant(PlantOptions{.n = kCoordinates,
                                                .n_u = kMotors,
                                                .last_tick = 0,
                                                .session = kScriptSession,
                                                .config = kScriptConfig},
                                   side);
  const auto state = script.next<state_t>("STATE");
  ASSERT_TRUE(state);
  EXPECT_EQ(state->n, kCoordinates);
  script.send("COMMAND", of_motors<command_t>(0, kCoordinates));
  script.send("COMMAND", of_motors<command_t>(0));
  EXPECT_EQ(plant.ending(), Ending::finished);
  EXPECT_EQ(plant.peer.report().rejects.of(Reject::dimension), 1U);
  EXPECT_EQ(side.measured, std::size_t{kCoordinates});
  EXPECT_EQ(side.commanded, std::size_t{kMotors});
}

TEST(FewerMotors, TheControllerAnswersForThem) {
  ScriptedPeer script{"COMMAND"};
  ControllerSide side;
  side.compute = [](const state_t& state, const reference_t& reference, std::int64_t, std::span<double> tau) {
    tau[0] = static_cast<double>(state.psi_measured.size());
    tau[1] = static_cast<double>(reference.psi_desired.size());
    return 0;
  };
  RunningPeer<ControllerPeer> peer(PeerOptions{.n = kCoordinates, .n_u = kMotors, .config = kScriptConfig},
                                   side);
  script.send_state(0);
  script.send("REFERENCE", of_motors<reference_t>(0));
  const auto command = next<command_t>(script, "COMMAND");
  ASSERT_TRUE(command);
  EXPECT_THAT(command->tau_commanded, testing::ElementsAre(kCoordinates, kMotors));
  script.send_end();
  EXPECT_EQ(peer.ending(), Ending::finished);
}

TEST(FewerMotors, ThePlannerRefersToThem) {
  ScriptedPeer script{"REFERENCE"};
  RunningPeer<PlannerPeer> peer(PeerOptions{.n = kCoordinates, .n_u = kMotors, .config = kScriptConfig},
                                PlannerSide{.refer = [](std::int64_t, reference_t&) {}, .begin = {}});
  script.send_state(0);
  const auto reference = next<reference_t>(script, "REFERENCE");
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->n, kMotors);
  script.send_end();
  EXPECT_EQ(peer.ending(), Ending::finished);
}

}  // namespace
}  // namespace mixloop
