// SPDX-License-Identifier: MIT
// Ctrl-C in whatever takes long: it ends soon, with exit status 130 and what there is.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/oracles/chains.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/terminal.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

// 0.2 s is what a person has to wait; a busy machine takes longer, and what isn't interrupted takes minutes.
constexpr milliseconds kSoon(1500);

/// Planned for some seconds: two million ticks.
const std::vector<std::string> kLongPlan = {"--set", "path.duration=2000 s"};
/// Planned at once and simulated for long: a lap again and again, by the slowest evaluation.
const std::vector<std::string> kLongRun = {"--set", "path.repeat=500", "--evaluation", "reference"};

std::vector<std::string> line(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.begin(), bin("mixloop"));
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Starts it, interrupts it after a while, and says how it ended.
int interrupted(Command& command, milliseconds after) {
  std::this_thread::sleep_for(after);
  EXPECT_TRUE(command.running()) << "too short to be interrupted: " << command.out() << command.err();
  command.signal(SIGINT);
  const auto at = std::chrono::steady_clock::now();
  const int status = command.wait(kSoon);
  EXPECT_LT(std::chrono::steady_clock::now() - at, kSoon);
  return status;
}

TEST(Interrupted, WhilePlanningEveryCommandEnds) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"simulate", experiment("paper")},
                                             {"run", experiment("paper")},
                                             {"track", experiment("paper"), "--over-bus"},
                                             {"track", experiment("paper"), "--attach"},
                                             {"stability", experiment("paper")}}) {
    SCOPED_TRACE(words[0] + (words.size() > 2 ? words[2] : ""));
    Command command(line(words, kLongPlan));
    EXPECT_EQ(interrupted(command, milliseconds(400)), 130);
    EXPECT_THAT(command.out() + command.err(), HasSubstr("interrupted"));
  }
}

TEST(Interrupted, PlanningSaysOnATerminalHowFarItIs) {
  Terminal screen(line({"simulate", experiment("paper")}, kLongPlan), {"TERM=vt100"}, 24, 80);
  EXPECT_TRUE(screen.shows("planning the path: ")) << screen.screen();
  screen.type("\x03");  // Ctrl-C
  EXPECT_EQ(screen.wait(kSoon), 130);
  EXPECT_THAT(screen.screen(), HasSubstr("interrupted while planning the path"));
}

TEST(Interrupted, ARunWhoseProcessesStillPlanEndsThemToo) {
  // Long to plan: an instrumented build takes ten times as long.
  const char* const duration = MIXLOOP_SANITIZED ? "path.duration=100 s" : "path.duration=1000 s";
  Command command(line({"run", experiment("paper")}, {"--set", duration}));
  ASSERT_TRUE(eventually([&] { return command.children().size() == 3; })) << command.err();
  const auto children = command.children();
  EXPECT_EQ(interrupted(command, milliseconds(100)), 130) << command.out() << command.err();
  for (const int pid : children) EXPECT_NE(kill(pid, 0), 0) << "left behind";
}

TEST(Interrupted, WhilePlanningTheProcessesEnd) {
  for (const char* name : {"mixloop-plant", "mixloop-controller", "mixloop-planner"}) {
    SCOPED_TRACE(name);
    Command command({bin(name), experiment("paper"), "--set", "path.duration=2000 s"});
    EXPECT_EQ(interrupted(command, milliseconds(400)), 130);
    EXPECT_THAT(command.err(), HasSubstr("interrupted while planning the path"));
  }
}

TEST(Interrupted, SimulationKeepsWhatItHas) {
  const ScratchFolder folder;
  Command command(line({"simulate", experiment("paper"), "--json", "--out", folder.file("kept")}, kLongRun));
  // The folder is begun when the path is planned.
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.file("kept")); })) << command.err();
  EXPECT_EQ(interrupted(command, milliseconds(1500)), 130) << command.err();
  const auto result = command.json();
  EXPECT_EQ(result["verdict"], "interrupted");
  EXPECT_GT(result["ticks"], 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("kept/result.json")));
}

TEST(Interrupted, TrackTellsOfEveryExperiment) {
  const ScratchFolder folder;
  Command quick(line({"track", experiment("paper")}, {}));  // its programs are compiled
  ASSERT_EQ(quick.wait(), 0);
  const std::string slow = folder.write(
      "slow.yaml", "scene: " + robot() +
                       "\npath: {line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, duration: 2000 s}\n"
                       "controller: {law: pd, kp: [100, 25, 25], kv: [1.0, 0.5, 0.5]}\n"
                       "parameters: {payload: 5 kg}\n");
  Command command(line(
      {"track", experiment("paper"), slow, experiment("via_points"), "--junit", folder.file("track.xml")},
      {}));
  ASSERT_TRUE(eventually([&] { return command.out().find("held") != std::string::npos; }));
  EXPECT_EQ(interrupted(command, milliseconds(1500)), 130) << command.out() << command.err();
  const std::string junit = bytes_of(folder.file("track.xml"));
  EXPECT_THAT(junit, HasSubstr("tests=\"3\" failures=\"0\" errors=\"0\" skipped=\"2\""));
  EXPECT_THAT(junit, HasSubstr("name=\"paper\""));
  EXPECT_THAT(junit, HasSubstr("<skipped message=\"interrupted while planning the path\"/>"));
  EXPECT_THAT(junit, HasSubstr("<skipped message=\"interrupted before it began\"/>"));
  EXPECT_THAT(junit, HasSubstr("</testsuite>"));
}

TEST(Interrupted, StabilityTellsTheCasesThatItHas) {
  std::string many = "parameters.payload=1 kg";
  for (int i = 2; i < 200; ++i) many += "," + std::to_string(i) + " kg";
  Command command(line({"stability", experiment("paper"), "--json", "--vary", many}, {}));
  EXPECT_EQ(interrupted(command, milliseconds(4000)), 130) << command.err();
  const auto result = command.json();
  EXPECT_THAT(result["interrupted"].get<std::string>(), HasSubstr("interrupted"));
  EXPECT_LT(result["cases"].size(), 199U);
}

TEST(Interrupted, DoctorTellsWhatItHas) {
  Command command(line({"doctor", "--json", "--seconds", "60"}, {}));
  EXPECT_EQ(interrupted(command, milliseconds(700)), 130) << command.err();
  EXPECT_EQ(command.json()["fit"], false);
  EXPECT_GT(command.json()["findings"].size(), 3U);
}

TEST(Interrupted, WhileTracingTheLargestSceneEndsSoon) {
  const ScratchFolder folder;
  const std::string scene = folder.write("large.yaml", oracle::coiled_chain(1000));
  Command command(line({"explain", scene}, {}));
  EXPECT_EQ(interrupted(command, milliseconds(400)), 130) << command.out() << command.err();
}

TEST(Interrupted, CompilingLeavesNothingBehind) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "cache");
  std::filesystem::permissions(folder.path() / "cache", std::filesystem::perms::owner_all);
  Command command({bin("mixloop"), "compile", robot(), "--json"}, {"MIXLOOP_CACHE=" + folder.file("cache")});
  EXPECT_EQ(interrupted(command, milliseconds(300)), 130);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "cache"))
    EXPECT_EQ(entry.path().extension(), ".so") << "a workshop is left: " << entry.path();
}

}  // namespace
}  // namespace mixloop
