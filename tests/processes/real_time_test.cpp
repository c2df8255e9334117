// SPDX-License-Identifier: MIT
// `mixloop run --realtime`, its operator, and its bad days. Slowed down, so that the ticks that may be missed
// bear a busy machine's holes; started paused, so that what is done to it takes none of its time.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>

#include "tests/support/command.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

std::vector<std::string> real_time(std::initializer_list<std::string> more = {}, const char* speed = "0.2") {
  std::vector<std::string> words = {bin("mixloop"), "run",        experiment("paper"),
                                    "--json",       "--realtime", "--speed",
                                    speed,          "--set",      "limits.position_error=1 m"};
  words.insert(words.end(), more);
  return words;
}

int pid_of(const Command& run, const std::string& name) {
  for (const int pid : run.children()) {
    const auto program = std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe").filename();
    if (program == name) return pid;
  }
  ADD_FAILURE() << "no " << name;
  return -1;
}

/// `mixloop control`, which must reach the plant; what it says.
nlohmann::json control(std::initializer_list<std::string> words) {
  std::vector<std::string> line = {bin("mixloop"), "control"};
  line.insert(line.end(), words);
  line.emplace_back("--json");
  Command command(line);
  EXPECT_EQ(command.wait(), 0) << command.err();
  return command.json();
}

/// Steps a session that was started paused to a tick.
nlohmann::json go_to_tick(int tick) {
  auto before = control({"step", std::to_string(tick), "--patience", "60"});
  EXPECT_TRUE(heard_tick(tick));
  return before;
}

/// The run of `result` again, from the ages.csv in a folder.
void expect_the_same_again(const nlohmann::json& result, const ScratchFolder& folder) {
  Command again({bin("mixloop"), "simulate", experiment("paper"), "--json", "--ages",
                 folder.file("kept/ages.csv"), "--set", "limits.position_error=1 m"});
  again.wait();
  EXPECT_EQ(again.json()["trajectory_sha256"], result["trajectory_sha256"]);
  EXPECT_EQ(again.json()["max_position_error"], result["max_position_error"]);
  EXPECT_EQ(again.json().contains("safe_at"), result.contains("safe_at"));
}

TEST(RunInRealTime, IsGoneThroughAgainBitByBitFromItsAges) {
  const ScratchFolder folder;
  Command run(real_time({"--out", folder.file("kept")}));
  run.wait();
  const auto result = run.json();
  ASSERT_EQ(result["route"], "real_time") << result;
  EXPECT_GE(result["wall_time"], 5.0);
  for (const char* key : {"missed_deadlines", "longest_miss", "success_last_100", "overruns", "wake_up_p50",
                          "wake_up_p99", "wake_up_p999", "wake_up_max", "round_trip_p50"})
    EXPECT_TRUE(result.contains(key)) << key;
  expect_the_same_again(result, folder);
}

// Bad days at once: references that are extrapolated, then missing, and a motor that gives nothing.
TEST(RunInRealTime, IsGoneThroughAgainWithItsFaultsAndExtrapolations) {
  const ScratchFolder folder;
  Command run(real_time({"--out", folder.file("kept"), "--allow-faults", "--paused"}, "0.1"));
  go_to_tick(50);
  control({"fault", "motor", "off", "--index", "3"});
  const int planner = pid_of(run, "mixloop-planner");
  kill(planner, SIGSTOP);
  control({"resume"});
  EXPECT_TRUE(heard_tick(58));
  kill(planner, SIGCONT);
  EXPECT_TRUE(heard_tick(70));
  kill(planner, SIGSTOP);
  EXPECT_TRUE(heard_safe_state());
  kill(planner, SIGCONT);
  control({"speed", "2"});
  EXPECT_EQ(run.wait(), 3) << run.err();
  std::ifstream file(folder.file("kept/ages.csv"));
  const std::string ages{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(ages, HasSubstr("extrapolated"));
  EXPECT_THAT(ages, HasSubstr("fault: motor off 3"));
  EXPECT_THAT(ages, HasSubstr("safe state: the controller sends safe commands"));
  expect_the_same_again(run.json(), folder);
}

TEST(RunInRealTime, GoesIntoItsSafeStateWhileAPeerIsSuspended) {
  const std::pair<const char*, const char*> cases[] = {{"mixloop-controller", "commands missed"},
                                                       {"mixloop-planner", "controller sends safe commands"},
                                                       {"mixloop-plant", "suspended"}};
  for (const auto& [victim, cause] : cases) {
    SCOPED_TRACE(victim);
    const ScratchFolder folder;
    Command run(real_time({"--out", folder.file("kept"), "--paused"}, "0.1"));
    go_to_tick(50);
    const int pid = pid_of(run, victim);
    control({"resume"});
    EXPECT_TRUE(heard_tick(52));
    kill(pid, SIGSTOP);
    std::this_thread::sleep_for(800ms);  // 80 ticks; 20 are borne
    kill(pid, SIGCONT);
    EXPECT_TRUE(heard_safe_state());
    control({"speed", "2"});
    EXPECT_EQ(run.wait(), 3) << run.err();
    const auto result = run.json();
    EXPECT_EQ(result["verdict"], "safe_state");
    EXPECT_THAT(result["safe_cause"].get<std::string>(), HasSubstr(cause));
    EXPECT_EQ(result["safe_state"], "hold");
    EXPECT_GT(result["safe_at"], 0.0);
    EXPECT_EQ(result["ticks"], 1000) << "in its safe state time goes on";
    expect_the_same_again(result, folder);
  }
}

TEST(RunInRealTime, IsPausedSteppedResetAndStoppedByItsOperator) {
  Command run(real_time({"--paused", "--hold"}, "1"));
  EXPECT_TRUE(heard_tick(0));
  const auto paused = control({"step", "10"});
  EXPECT_EQ(paused["tick"], 0);
  EXPECT_TRUE(heard_tick(10));
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(control({"speed", "0.5"})["tick"], 10) << "it goes no further";
  control({"resume"});
  EXPECT_TRUE(heard_tick(30));
  EXPECT_GE(control({"reset"})["tick"], 30);
  const std::int64_t session = paused["session"];
  EXPECT_TRUE(heard_state([session](const state_t& state) { return state.session != session; }));
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(control({"resume"})["tick"], 0) << "it was started paused, and so is the new session";
  EXPECT_TRUE(heard_tick(20));
  control({"stop"});
  EXPECT_EQ(run.wait(), 130) << run.err();
}

// A motor that gives nothing lets go of the arm, after a reset too; without --allow-faults nobody is obeyed.
TEST(RunInRealTime, ObeysAFaultOnlyWhereThatIsAllowed) {
  for (const bool allowed : {true, false}) {
    SCOPED_TRACE(allowed);
    std::vector<std::string> line =
        real_time({"--paused", "--set", "real_time.max_missed=1000"}, allowed ? "0.5" : "0.2");
    if (allowed) line.emplace_back("--allow-faults");
    Command run(line);
    const std::int64_t session = go_to_tick(50)["session"];
    control({"reset"});
    EXPECT_TRUE(heard_state([session](const state_t& state) { return state.session != session; }));
    go_to_tick(50);
    control({"fault", "motor", "off", "--index", "2"});
    control({"resume"});
    run.wait();
    const auto result = run.json();
    ASSERT_TRUE(result.contains("max_position_error")) << result;
    if (allowed)
      EXPECT_GT(result["max_position_error"], 0.1);
    else
      EXPECT_LT(result["max_position_error"], 0.1);
  }
}

TEST(RunInRealTime, HasNoSpeedMaxAndControlSaysSo) {
  Command run(real_time({"--paused"}));
  Command speed({bin("mixloop"), "control", "speed", "max", "--patience", "60"});
  EXPECT_EQ(speed.wait(), 2);
  EXPECT_THAT(speed.err(), HasSubstr("in real time there is no 'max'"));
  control({"stop"});
  run.wait();
}

TEST(RunInRealTime, SaysThatControlHasNoPlant) {
  Command command({bin("mixloop"), "control", "pause", "--patience", "0.1", "--json"});
  EXPECT_EQ(command.wait(), 3);
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), HasSubstr("MIXLOOP_STATE"));
}

TEST(RunInRealTime, RefusesSpeedMax) {
  Command command(real_time({}, "max"));
  EXPECT_EQ(command.wait(), 2);
  EXPECT_THAT(command.out() + command.err(), HasSubstr("real time"));
}

}  // namespace
}  // namespace mixloop
