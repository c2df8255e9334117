// SPDX-License-Identifier: MIT
// `mixloop run --realtime`, its operator, and its bad days. Slowed down five times, so that a busy machine's
// holes are short against a tick.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>

#include "tests/support/command.hpp"
#include "tests/tools/heard.hpp"
#include "tests/tools/paths.hpp"

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
  Command run(real_time({"--out", folder.file("kept"), "--allow-faults"}, "0.5"));
  ASSERT_TRUE(heard("COMMAND", 50));
  Command control({bin("mixloop"), "control", "fault", "motor", "off", "--index", "3", "--json"});
  EXPECT_EQ(control.wait(), 0) << control.err();
  const int planner = pid_of(run, "mixloop-planner");
  for (const auto pause : {15ms, 15ms, 15ms, 300ms}) {
    kill(planner, SIGSTOP);
    std::this_thread::sleep_for(pause);
    kill(planner, SIGCONT);
    std::this_thread::sleep_for(30ms);
  }
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
    Command run(real_time({"--out", folder.file("kept")}, "0.5"));
    ASSERT_TRUE(heard("COMMAND", 50));
    const int pid = pid_of(run, victim);
    kill(pid, SIGSTOP);
    std::this_thread::sleep_for(500ms);
    kill(pid, SIGCONT);
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
  const auto control = [](std::initializer_list<std::string> words) {
    std::vector<std::string> line = {bin("mixloop"), "control"};
    line.insert(line.end(), words);
    line.emplace_back("--json");
    Command command(line);
    EXPECT_EQ(command.wait(), 0) << command.err();
    return command.json();
  };
  ASSERT_TRUE(heard("COMMAND", 1));
  const auto paused = control({"step", "10"});
  std::this_thread::sleep_for(300ms);
  const auto stepped = control({"speed", "0.5"});
  EXPECT_EQ(paused["tick"], 0);
  EXPECT_EQ(stepped["tick"], 10);
  control({"resume"});
  ASSERT_TRUE(heard("COMMAND", 20));
  const auto going = control({"reset"});
  EXPECT_GT(going["tick"], 10);
  std::this_thread::sleep_for(300ms);
  const auto fresh = control({"resume"});
  EXPECT_NE(fresh["session"], paused["session"]);
  EXPECT_EQ(fresh["tick"], 0) << "it was started paused, and so is the new session";
  ASSERT_TRUE(heard("COMMAND", 20));
  control({"stop"});
  EXPECT_EQ(run.wait(), 130) << run.err();
}

// A motor that gives nothing lets go of the arm, after a reset too; without --allow-faults nobody is obeyed.
TEST(RunInRealTime, ObeysAFaultOnlyWhereThatIsAllowed) {
  for (const bool allowed : {true, false}) {
    SCOPED_TRACE(allowed);
    std::vector<std::string> line = {bin("mixloop"), "run",   experiment("paper"),        "--json", "--speed",
                                     "0.5",          "--set", "limits.position_error=1 m"};
    if (allowed) line.emplace_back("--allow-faults");
    Command run(line);
    ASSERT_TRUE(heard("COMMAND", 100));
    Command reset({bin("mixloop"), "control", "reset", "--json"});
    EXPECT_EQ(reset.wait(), 0) << reset.err();
    ASSERT_TRUE(heard("COMMAND", 100));
    Command control({bin("mixloop"), "control", "fault", "motor", "off", "--index", "2", "--json"});
    EXPECT_EQ(control.wait(), 0) << control.err();
    run.wait();
    const auto result = run.json();
    ASSERT_TRUE(result.contains("max_position_error")) << result;
    if (allowed)
      EXPECT_GT(result["max_position_error"], 0.1);
    else
      EXPECT_LT(result["max_position_error"], 0.1);
  }
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
