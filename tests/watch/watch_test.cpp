// SPDX-License-Identifier: MIT
// What a viewer makes of messages, on a simulated clock.
#include "watch/watch.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "watch/watch_text.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kSession = 7;

std::string text_of(const WatchView& view, std::size_t width = 80, std::size_t height = 24) {
  std::string all;
  for (const Line& line : watch_lines(view, width, height)) all += to_text(line) + "\n";
  return all;
}

/// Sends messages to a watch, a tick a millisecond.
class Script {
 public:
  explicit Script(int n = 3) : watch("MIXLOOP_", std::nullopt, Instant(0)), n_(n) {}

  template <class Message>
  Message message(std::int64_t tick, std::int64_t session = kSession) const {
    Message m = blank<Message>(n_);
    set_header(m, {.n = n_, .utime = 1000 * tick, .seq = tick, .session = session});
    return m;
  }
  template <class Message>
  void send(Channel channel, const Message& m) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    watch.take(channel, bytes, at);
  }
  void state(std::int64_t tick, std::vector<double> psi, std::int64_t session = kSession) {
    auto m = message<state_t>(tick, session);
    m.psi_measured = std::move(psi);
    send(Channel::state, m);
  }
  void reference(std::int64_t tick, std::vector<double> psi, std::int8_t phase = reference_t::PHASE_PATH) {
    auto m = message<reference_t>(tick);
    m.psi_desired = std::move(psi);
    m.phase = phase;
    m.position_desired[0] = 1;
    send(Channel::reference, m);
  }
  void truth(std::int64_t tick, double x, double y) {
    auto m = message<truth_t>(tick);
    m.position[0] = x, m.position[1] = y;
    send(Channel::truth, m);
  }
  void command(std::int64_t tick, std::vector<double> tau) {
    auto m = message<command_t>(tick);
    m.tau_commanded = std::move(tau);
    send(Channel::command, m);
  }
  ChannelView channel(Channel c) { return watch.view(at).channels[static_cast<std::size_t>(c)]; }
  std::string text() { return text_of(watch.view(at)); }

  Watch watch;
  Instant at{0};

 private:
  int n_;
};

TEST(Watch, CountsRatesAgesLossesAndRepeats) {
  Script script;
  for (std::int64_t k = 0; k < 500; ++k) {
    script.at += milliseconds(4);
    if (k < 100 || k >= 103) script.state(k, {0, 0, 0});  // three are lost
    if (k == 300) script.state(k, {0, 0, 0});
    if (k % 50 == 0) script.watch.view(script.at);  // as a screen that is drawn now and then
  }
  script.at += milliseconds(10);
  const ChannelView state = script.channel(Channel::state);
  EXPECT_EQ(state.received, 498);
  EXPECT_EQ(state.lost, 3);
  EXPECT_EQ(state.repeated, 1);
  EXPECT_NEAR(state.rate_hz, 250, 3);  // of the last second or a little more; 10 ms of it silent
  EXPECT_DOUBLE_EQ(*state.age, 0.010);
  EXPECT_FALSE(script.channel(Channel::timing).age);
  EXPECT_FALSE(script.channel(Channel::timing).lost) << "TIMING doesn't come by tick";
}

TEST(Watch, DoesNotCountWhatItMissedBeforeItListened) {
  Script script;
  script.state(5000, {0, 0, 0});
  script.state(5001, {0, 0, 0});
  EXPECT_EQ(script.channel(Channel::state).lost, 0);
}

TEST(Watch, ComparesStateAndReferenceOfTheSameTickWhicheverComesFirst) {
  Script script;
  script.state(0, {0, 0, 0});
  script.reference(0, {0, 0, 0});
  script.reference(1, {10, 20, 30});  // a tick ahead
  script.state(1, {9, 22, 30});
  script.state(2, {0, 0, 0});
  EXPECT_EQ(script.watch.view(script.at).motors[0].error.now, 1)
      << "not of tick 2, whose reference is not there";
  script.reference(2, {0.5, 0, 0});
  const auto motors = script.watch.view(script.at).motors;
  EXPECT_EQ(motors[0].error.now, 0.5);
  EXPECT_EQ(motors[0].error.worst, 1);
  EXPECT_EQ(motors[1].error.worst, -2);
  EXPECT_EQ(motors[2].error.worst, 0);
}

TEST(Watch, TakesThePositionErrorFromTruthWithoutTheMoveToTheStart) {
  Script script;
  script.state(0, {0, 0, 0});
  script.reference(0, {0, 0, 0}, reference_t::PHASE_MOVE_TO_START);
  script.truth(0, 5, 5);
  EXPECT_FALSE(script.watch.view(script.at).position_error);
  script.reference(1, {0, 0, 0});
  script.truth(1, 1 + 0.003, 0.004);  // desired (1, 0, 0): 3, 4, 5 mm
  script.reference(2, {0, 0, 0});
  script.truth(2, 1, 0.001);
  const WatchView view = script.watch.view(script.at);
  // 1.003 is rounded: to 2^-53 of it.
  EXPECT_NEAR(view.position_error->worst, 0.005, 1e-15);
  EXPECT_EQ(view.position_error->now, 0.001);
  EXPECT_EQ(view.worst_at, 0.001);
  EXPECT_EQ(view.position_source, "truth");
  script.watch.forget_the_worst();
  EXPECT_FALSE(script.watch.view(script.at).position_error);
}

TEST(Watch, KeepsTheLargestTorqueWithItsSign) {
  Script script;
  script.state(0, {0, 0, 0});
  script.command(0, {1, -4, 0});
  script.command(1, {2, 3, 0});
  const auto motors = script.watch.view(script.at).motors;
  EXPECT_EQ(motors[0].torque.worst, 2);
  EXPECT_EQ(motors[1].torque.worst, -4);
  EXPECT_EQ(motors[1].torque.now, 3);
  EXPECT_FALSE(motors[0].limit) << "no experiment, no limits";
}

TEST(Watch, HoldsItselfToOneRun) {
  Script script;
  script.state(10, {0, 0, 0});
  script.command(10, {9, 9, 9});
  script.at += milliseconds(500);
  script.state(0, {0, 0, 0}, kSession + 1);
  EXPECT_EQ(script.watch.view(script.at).session, kSession) << "the first run is not quiet yet";
  EXPECT_EQ(script.watch.view(script.at).other_sessions, 1);
  script.at += milliseconds(1001);
  EXPECT_EQ(script.watch.view(script.at).condition, Condition::silent);
  script.state(0, {0, 0, 0}, kSession + 1);
  const WatchView view = script.watch.view(script.at);
  EXPECT_EQ(view.session, kSession + 1);
  EXPECT_EQ(view.motors[0].torque.worst, 0) << "of the run before";
  EXPECT_EQ(view.channels[0].lost, 0);
}

TEST(Watch, FollowsThePlantsResetAtOnce) {
  Script script;
  script.state(10, {0, 0, 0});
  auto reset = script.message<sim_control_t>(0);
  reset.action = sim_control_t::ACTION_RESET;
  script.send(Channel::sim_control, reset);  // an operator's, who cannot know what comes next
  script.state(11, {0, 0, 0});
  EXPECT_EQ(script.watch.view(script.at).tick, 11);
  reset.seq = kSession + 1;
  script.send(Channel::sim_control, reset);
  script.state(0, {0, 0, 0}, kSession + 1);
  const WatchView view = script.watch.view(script.at);
  EXPECT_EQ(view.session, kSession + 1);
  EXPECT_EQ(view.tick, 0);
  EXPECT_EQ(view.other_sessions, 0);
}

TEST(Watch, SaysWhyTheControllerGoesByNoReference) {
  Script script;
  script.state(0, {0, 0, 0});
  auto command = script.message<command_t>(0);
  const auto warning = [&](std::int32_t flags) {
    command.flags = flags;
    script.send(Channel::command, command);
    return script.watch.view(script.at).warnings;
  };
  constexpr std::int32_t kSafe = command_t::FLAG_SAFE;
  EXPECT_THAT(warning(extrapolation_flags(7)), ElementsAre(HasSubstr("extrapolated, by 7 ticks")));
  EXPECT_THAT(warning(kSafe | command_t::FLAG_WITHOUT_REFERENCE), ElementsAre(HasSubstr("no reference")));
  EXPECT_THAT(warning(kSafe | command_t::FLAG_AFTERWARDS), ElementsAre(HasSubstr("no newer state")));
  EXPECT_THAT(warning(0), IsEmpty());
}

TEST(Watch, CountsWhatItCannotTake) {
  Script script;
  script.state(0, {0, 0, 0});
  script.command(0, {1, std::numeric_limits<double>::quiet_NaN(), 0});
  script.send(Channel::command, script.message<state_t>(1));       // another type
  script.send(Channel::command, Script(2).message<command_t>(1));  // another n
  script.watch.take(Channel::command, {}, script.at);
  const auto view = script.watch.view(script.at);
  EXPECT_EQ(script.channel(Channel::command).bad, 4);
  EXPECT_EQ(view.motors[0].torque.worst, 0);
}

TEST(Watch, TellsAPlantThatWaitsFromOneThatIsSilentOrPaused) {
  Script script;
  const auto condition = [&] { return script.watch.view(script.at).condition; };
  script.state(4, {0, 0, 0});
  for (int i = 0; i < 12; ++i) {  // its STATE again and again, and answers that it can't take
    script.at += milliseconds(100);
    script.state(4, {0, 0, 0});
    script.command(4, {std::nan(""), 0, 0});
    script.command(3, {0, 0, 0});
  }
  EXPECT_EQ(condition(), Condition::waiting);
  timing_t timing = script.message<timing_t>(4);
  timing.rejected_not_finite = 12, timing.rejected_dimension = 3;
  script.send(Channel::timing, timing);
  EXPECT_THAT(script.watch.view(script.at).warnings,
              ElementsAre("the plant has dropped 3 dimension, 12 not_finite"));
  EXPECT_THAT(script.text(),
              AllOf(HasSubstr("waiting: no COMMAND that answers tick 4"), HasSubstr("12 not_finite")));
  script.command(4, {0, 0, 0});
  EXPECT_EQ(condition(), Condition::paused);
  script.at += milliseconds(1100);
  EXPECT_EQ(condition(), Condition::silent);
}

TEST(Watch, NamesWhatTheOthersWereStartedWith) {
  Script script;
  script.state(0, {0, 0, 0});
  auto command = script.message<command_t>(0);
  command.config = 1LL << 48 | 1;
  script.send(Channel::command, command);
  auto reference = script.message<reference_t>(0);
  reference.config = 1LL << 16;
  script.send(Channel::reference, reference);
  EXPECT_THAT(script.watch.view(script.at).warnings,
              ElementsAre("the controller was started with another rate and shared parameters than the plant",
                          "the planner was started with another path than the plant"));
}

TEST(Watch, SaysHowTheRunStands) {
  Script script;
  const auto condition = [&] { return script.watch.view(script.at).condition; };
  EXPECT_EQ(condition(), Condition::silent);
  script.state(0, {0, 0, 0});
  script.reference(0, {0, 0, 0}, reference_t::PHASE_MOVE_TO_START);
  EXPECT_EQ(condition(), Condition::moving_to_start);
  script.state(1, {0, 0, 0});
  script.reference(1, {0, 0, 0});
  EXPECT_EQ(condition(), Condition::on_path);
  script.state(2, {0, 0, 0});
  script.reference(2, {0, 0, 0}, reference_t::PHASE_HOLD);
  EXPECT_EQ(condition(), Condition::holding);
  auto state = script.message<state_t>(3);
  state.flags = state_t::FLAG_SAFE_STATE;
  script.send(Channel::state, state);
  EXPECT_EQ(condition(), Condition::safe_state);
  script.watch.take(Channel::stop, {}, script.at);
  EXPECT_EQ(condition(), Condition::stopped) << "whatever a STOP's fields say";
  auto end = script.message<sim_control_t>(3);
  end.action = sim_control_t::ACTION_END, end.reason = sim_control_t::REASON_STOPPED;
  script.send(Channel::sim_control, end);
  EXPECT_EQ(condition(), Condition::ended);
  EXPECT_EQ(script.watch.view(script.at).ending, Ending::stopped);
  const auto json = watch_json(script.watch.view(script.at));
  EXPECT_EQ(json["condition"], "ended");
  EXPECT_EQ(json["ending"], "stopped");
}

TEST(Watch, TellsTheTimesBetweenMessages) {
  Script script;
  for (std::int64_t k = 0; k < 100; ++k) {
    script.state(k, {0, 0, 0});
    script.at += std::chrono::microseconds(300);
    script.command(k, {0, 0, 0});
    script.at += std::chrono::microseconds(700);
  }
  const WatchView view = script.watch.view(script.at);
  EXPECT_EQ(view.command_after_state.count, 100);
  EXPECT_EQ(view.command_after_state.max, std::chrono::microseconds(300));
  EXPECT_EQ(view.state_interval.count, 99);
  EXPECT_EQ(view.state_interval.max, milliseconds(1));
}

/// Everything heard, of n motors, with a plant in real time.
WatchView busy(int n) {
  Script script(n);
  const std::vector<double> some(static_cast<std::size_t>(n), 1.5);
  auto state = script.message<state_t>(123456789);
  state.flags = state_t::FLAG_REAL_TIME;
  script.send(Channel::state, state);
  script.reference(123456789, some);
  script.command(123456789, some);
  script.truth(123456789, 1.1, 0);
  auto timing = script.message<timing_t>(123456789);
  timing.missed = 12, timing.longest_miss = 3, timing.success_last_100 = 0.97;
  timing.round_trip_p50 = 57'000, timing.round_trip_p99 = 1'234'000, timing.round_trip_max = 53'107'000;
  timing.wake_up_max = 250'000, timing.rejected_stale = 4, timing.rejected_length = 1;
  script.send(Channel::timing, timing);
  script.send(Channel::sim_control, script.message<sim_control_t>(0));
  script.send(Channel::fault, script.message<fault_t>(0));
  script.watch.take(Channel::stop, {}, script.at);
  return script.watch.view(script.at);
}

TEST(WatchText, ShowsAllOfThreeMotorsIn80By24) {
  // The last of the 24 lines is for the keys.
  const std::string text = text_of(busy(3), 80, 23);
  for (const char* channel : kChannelNames) EXPECT_THAT(text, HasSubstr(std::string("MIXLOOP_") + channel));
  EXPECT_THAT(text,
              AllOf(HasSubstr("real time"), HasSubstr("worst 100.0000 mm at 123456.789 s, by the truth"),
                    HasSubstr("\n3       1.500000"), HasSubstr("here: state to command")));
  EXPECT_THAT(text, HasSubstr("plant: round trip            57 us   1.23 ms   53.1 ms"));
  EXPECT_THAT(text, HasSubstr("missed 12 (in a row 3), in time 97 % of the last 100, dropped 5\noverruns 0"));
}

TEST(WatchText, StaysWithinAnySize) {
  for (const int n : {1, 3, 40})
    for (std::size_t width : {0, 1, 20, 79, 80, 300})
      for (std::size_t height : {0, 1, 5, 10, 23, 24, 60}) {
        const auto lines = watch_lines(busy(n), width, height);
        EXPECT_LE(lines.size(), height);
        for (const Line& line : lines) EXPECT_LE(to_text(line).size(), width);
      }
  EXPECT_THAT(text_of(busy(40), 80, 30), HasSubstr("more: a taller terminal shows them"));
  EXPECT_THAT(text_of(busy(40), 80, 100), AllOf(HasSubstr("\n40 "), Not(HasSubstr("more: a taller"))));
}

TEST(WatchText, IsWholeWhereThereIsNoWidth) {
  WatchView view = busy(3);
  view.warnings = {std::string(200, 'w')};
  view.channels[0].name = std::string(40, 'c');
  std::string text;
  for (const Line& line : whole_watch_lines(view)) text += to_text(line) + '\n';
  EXPECT_THAT(text, AllOf(HasSubstr(std::string(200, 'w')), HasSubstr(std::string(40, 'c') + " ")));
}

TEST(WatchText, SaysThatNoTimingWasHeard) {
  Script script;
  script.state(0, {0, 0, 0});
  EXPECT_THAT(script.text(), HasSubstr("no TIMING heard yet"));
  EXPECT_THAT(script.text(), HasSubstr("not heard: MIXLOOP_REFERENCE"));
}

TEST(WatchText, HasADashForWhatWasNeverMeasured) {
  Script script;
  script.state(0, {0, 0, 0});
  script.reference(0, {1, 0, 0}, reference_t::PHASE_MOVE_TO_START);
  script.send(Channel::timing, script.message<timing_t>(0));
  EXPECT_THAT(script.text(), HasSubstr("\n1       1.000000          -         -         -"));
  EXPECT_THAT(script.text(), HasSubstr("plant: round trip                -         -         -"));
}

TEST(WatchText, DrawsTorquesAgainstTheirLargest) {
  Script script;
  script.state(0, {0, 0, 0});
  script.command(0, {2, -4, 0});
  script.command(1, {1, -4, 0});
  const std::string text = script.text();
  EXPECT_THAT(text, AllOf(HasSubstr("[          |=====     ]"), HasSubstr("[==========|          ]"),
                          HasSubstr("[          |          ]")));
}

TEST(WatchJson, GivesNullForWhatIsNotKnownAndSiUnits) {
  Script script;
  script.state(0, {0, 0, 0});
  auto json = watch_json(script.watch.view(script.at));
  for (const char* key : {"position_error", "max_position_error", "torque_limit", "applied_torque", "timing",
                          "torque", "max_torque", "motor_error", "max_motor_error", "torque_unit"})
    EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_TRUE(json["command_after_state"]["p50"].is_null());
  EXPECT_FALSE(json.contains("error")) << "that is for errors";
  json = watch_json(busy(3));
  EXPECT_DOUBLE_EQ(json["timing"]["round_trip_max"], 0.053107);
  EXPECT_EQ(json["timing"]["rejected_stale"], 4);
  EXPECT_EQ(json["channels"]["MIXLOOP_STATE"]["lost"], 0);
  EXPECT_THAT(json["applied_torque"].get<std::vector<double>>(), ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace mixloop
