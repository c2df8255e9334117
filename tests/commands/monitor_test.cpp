// SPDX-License-Identifier: MIT
// `mixloop monitor` beside live processes, and on a terminal.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/heard.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/terminal.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Monitor, MeasuresWhatTheRunItselfMeasures) {
  // By the experiment's kinematics, and by TRUTH alone.
  Command by_experiment(
      {bin("mixloop"), "monitor", experiment("paper"), "--json", "--seconds", "60", "--patience", "60"}),
      by_truth({bin("mixloop"), "monitor", "--json", "--seconds", "60", "--patience", "60"});
  ASSERT_TRUE(eventually([] { return listeners() == 2; })) << "were they late, `lost` would not say so";
  Command run({bin("mixloop"), "run", experiment("paper"), "--truth", "--json", "--speed", "1"});
  ASSERT_EQ(run.wait(), 0) << run.err();
  const auto own = run.json();
  for (const auto& [monitor, source] : std::initializer_list<std::pair<Command*, std::string>>{
           {&by_experiment, "experiment"}, {&by_truth, "truth"}}) {
    ASSERT_EQ(monitor->wait(), 0) << monitor->err();
    const auto seen = monitor->json();
    SCOPED_TRACE(seen.dump(1));
    EXPECT_EQ(seen["position_source"], source);
    EXPECT_EQ(seen["condition"], "ended");
    EXPECT_EQ(seen["ending"], "finished");
    EXPECT_TRUE(seen["warnings"].empty());
    const auto& channels = seen["channels"];
    EXPECT_GT(channels["MIXLOOP_TIMING"]["received"], 0);
    bool complete = true;
    for (const char* name : {"STATE", "REFERENCE", "COMMAND", "TRUTH"}) {
      const auto& channel = channels[std::string("MIXLOOP_") + name];
      EXPECT_EQ(channel["bad"], 0);
      complete = complete && channel["lost"] == 0 && channel["received"] >= 1001;
    }
    // A viewer may lose messages on a busy machine: then its worst may be less.
    EXPECT_LE(seen["max_position_error"], own["max_position_error"].get<double>() + 1e-12);
    if (!complete) continue;
    // Truth is the plant's own number; kinematics are evaluated by the interpreter here: to round-off of 1 m.
    EXPECT_NEAR(seen["max_position_error"], own["max_position_error"].get<double>(), 1e-14);
    EXPECT_DOUBLE_EQ(seen["time_of_max_position_error"], own["time_of_max_position_error"]);
    EXPECT_EQ(seen["max_torque"], own["max_torque"]);
  }
}

TEST(Monitor, SaysThatNobodyIsThere) {
  expect_refused({"monitor", "--patience", "0.2"}, 3, "lost_peer", "network namespace");
}

TEST(Monitor, RefusesBadInput) {
  Command no_terminal({bin("mixloop"), "monitor"});
  EXPECT_EQ(no_terminal.wait(), 2);
  EXPECT_THAT(no_terminal.err(), HasSubstr("--once"));
  Command no_file({bin("mixloop"), "monitor", "none.yaml", "--json"});
  EXPECT_EQ(no_file.wait(), 2);
  // ncurses forgets what it has read of an unknown terminal.
  const std::string suppressions =
      "LSAN_OPTIONS=print_suppressions=0:suppressions=" MIXLOOP_SOURCE "/tests/support/lsan.supp";
  Terminal unknown({bin("mixloop"), "monitor"}, {"TERM=no-such", suppressions}, 24, 80);
  EXPECT_EQ(unknown.wait(), 2);
  EXPECT_THAT(unknown.screen(), HasSubstr("TERM=no-such"));
}

bool same(const termios& a, const termios& b) {
  return a.c_iflag == b.c_iflag && a.c_oflag == b.c_oflag && a.c_cflag == b.c_cflag && a.c_lflag == b.c_lflag;
}

TEST(Monitor, DrawsOn80By24FollowsTheSizeAndLeavesTheTerminalAsItWas) {
  Command run({bin("mixloop"), "run", experiment("paper"), "--speed", "1", "--hold", "--truth"});
  Terminal screen({bin("mixloop"), "monitor", "--lcm-url", "udpm://239.255.76.67:7667?ttl=0"},
                  {"TERM=xterm-256color", "NO_COLOR="}, 24, 80);
  const termios before = screen.settings();
  ASSERT_TRUE(screen.shows("holding the end of the path")) << screen.screen();
  ASSERT_TRUE(screen.shows("now 11.44")) << screen.screen();
  for (const char* line : {"plant: round trip", "\n3       0.0642", "\nq quits"})
    EXPECT_TRUE(screen.shows(line)) << line << '\n' << screen.screen();
  EXPECT_THAT(screen.screen(), AllOf(HasSubstr("\nMIXLOOP_STATE "), HasSubstr("\nMIXLOOP_COMMAND "),
                                     HasSubstr("\nposition error  now 11.44")));
  EXPECT_THAT(screen.sent(), HasSubstr("\033[30m\033[46m")) << "colours, where there are any";
  screen.resize(40, 132);
  EXPECT_TRUE(screen.shows("[" + std::string(36, ' ') + "|")) << "wider bars\n" << screen.screen();
  screen.type("q");
  EXPECT_EQ(screen.wait(), 0);
  EXPECT_THAT(screen.sent(), AllOf(HasSubstr("\033[?1049h"), HasSubstr("\033[?1049l")))
      << "the other screen is back";
  EXPECT_GT(screen.sent().rfind("\033[?25h"), screen.sent().rfind("\033[?25l")) << "the cursor is back";
  EXPECT_TRUE(same(screen.settings(), before));
  run.signal(SIGINT);
  run.wait();
}

TEST(Monitor, WorksWithoutColoursAndEndsByCtrlC) {
  Terminal screen({bin("mixloop"), "monitor"}, {"TERM=vt100"}, 24, 80);
  const termios before = screen.settings();
  ASSERT_TRUE(screen.shows("nothing heard of a plant yet")) << screen.screen();
  screen.type("\x03");
  EXPECT_EQ(screen.wait(), 130);
  EXPECT_TRUE(same(screen.settings(), before));
  for (char colour = '0'; colour <= '7'; ++colour)
    for (const char* plane : {"\033[3", "\033[4"})
      EXPECT_THAT(screen.sent(), Not(HasSubstr(std::string(plane) + colour + "m")));
}

}  // namespace
}  // namespace mixloop
