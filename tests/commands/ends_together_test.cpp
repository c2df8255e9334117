// SPDX-License-Identifier: MIT
// What `mixloop run` started ends with it, whatever ends it; and what is kept says how it ended.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

const std::vector<std::string> kLong = {"--set", "path.repeat=500"};

std::vector<std::string> long_run(const std::string& out) {
  std::vector<std::string> words = {bin("mixloop"), "run", experiment("paper"), "--json", "--speed", "1"};
  words.insert(words.end(), kLong.begin(), kLong.end());
  if (!out.empty()) words.insert(words.end(), {"--out", out});
  return words;
}

bool is_there(int pid) {
  // One that has ended and that nobody has collected yet is gone.
  const std::string status = bytes_of("/proc/" + std::to_string(pid) + "/stat");
  const auto name_end = status.rfind(')');
  return name_end != std::string::npos && status.substr(name_end + 2, 1) != "Z";
}

/// The process of ours among children; 0 where it isn't there yet.
int child_named(const Command& command, const std::string& name) {
  for (const int pid : command.children())
    if (bytes_of("/proc/" + std::to_string(pid) + "/cmdline").find(name) != std::string::npos) return pid;
  return 0;
}

TEST(EndsTogether, TheProcessesDieWithTheRunThatIsKilled) {
  Command command(long_run(""));
  ASSERT_TRUE(eventually([&] { return command.children().size() == 3; })) << command.err();
  const auto children = command.children();
  command.signal(SIGKILL);
  for (const int pid : children) EXPECT_TRUE(eventually([&] { return !is_there(pid); })) << "left behind";
}

// As they do where the kernel has forgotten what was asked for before the exec: of a file with capabilities.
TEST(EndsTogether, EachProcessAsksForItsParentsDeathItself) {
  for (const char* name : {"mixloop-plant", "mixloop-controller", "mixloop-planner"}) {
    SCOPED_TRACE(name);
    Command shell({"/bin/sh", "-c", "'" + bin(name) + "' '" + experiment("paper") + "' --parent $$ & wait"});
    int pid = 0;
    ASSERT_TRUE(eventually([&] { return (pid = child_named(shell, name)) != 0; })) << shell.err();
    shell.signal(SIGKILL);
    EXPECT_TRUE(eventually([&] { return !is_there(pid); })) << "left behind";
  }
}

TEST(EndsTogether, AProcessWhoseParentHasGoneEndsAtOnce) {
  Command orphan({bin("mixloop-controller"), experiment("paper"), "--parent", "1"});
  EXPECT_EQ(orphan.wait(), 128 + SIGKILL) << orphan.err();
}

// With the right that doctor advises.
TEST(EndsTogether, ProcessesWithCapabilitiesDieWithTheRunToo) {
  const ScratchFolder folder;
  ASSERT_EQ(chmod(folder.path().c_str(), 0755), 0);
  for (const char* name : {"mixloop", "mixloop-plant", "mixloop-controller", "mixloop-planner"})
    std::filesystem::copy_file(bin(name), folder.file(name));
  Command rights(
      {"/bin/sh", "-c",
       "cd '" + folder.path().string() +
           "' && setcap cap_sys_nice+ep mixloop-plant && setcap cap_sys_nice+ep mixloop-controller && "
           "setcap cap_sys_nice+ep mixloop-planner && setpriv --reuid 12345 --regid 12345 "
           "--clear-groups ./mixloop-planner --help"});
  if (rights.wait() != 0) GTEST_SKIP() << "no setcap, or not root's to use: " << rights.err();
  Command command({"/bin/sh", "-c",
                   "cd / && umask 022 && exec setpriv --reuid 12345 --regid 12345 --clear-groups '" +
                       folder.file("mixloop") + "' run '" + experiment("paper") +
                       "' --json --speed 1 --set path.repeat=500"},
                  {"MIXLOOP_CXX="});
  ASSERT_TRUE(eventually([&] { return command.children().size() == 3; })) << command.out() << command.err();
  const auto children = command.children();
  command.signal(SIGKILL);
  for (const int pid : children) EXPECT_TRUE(eventually([&] { return !is_there(pid); })) << "left behind";
}

TEST(EndsTogether, AHangUpEndsInOrderAndKeepsWhatThereIs) {
  for (const bool over_bus : {false, true}) {
    const ScratchFolder folder;
    const std::string kept = folder.file("kept");
    auto words = long_run(kept);
    if (!over_bus)
      words = {bin("mixloop"), "simulate",     experiment("paper"),
               "--json",       "--evaluation", "reference",
               "--out",        kept,           kLong[0],
               kLong[1]};
    Command command(words);
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(kept); })) << command.err();
    if (over_bus) {
      ASSERT_TRUE(eventually([&] { return bytes_of(kept + "/run.lcmlog").size() > 100'000; }))
          << command.err();
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    command.signal(SIGHUP);
    EXPECT_EQ(command.wait(), 130) << command.err();
    const auto result = nlohmann::json::parse(bytes_of(kept + "/result.json"));
    EXPECT_EQ(result["verdict"], "interrupted");
    EXPECT_EQ(result["exit_status"], 130);
    EXPECT_TRUE(std::filesystem::exists(kept + "/trajectory.csv"));
  }
}

TEST(EndsTogether, ThatWasStartedToOutliveItsTerminalHeedsNoHangUp) {
  Command command({"/bin/sh", "-c",
                   "trap '' HUP; exec '" + bin("mixloop") + "' simulate '" + experiment("paper") +
                       "' --json --evaluation reference --set path.repeat=100"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ASSERT_TRUE(command.running()) << command.err();
  command.signal(SIGHUP);
  EXPECT_NE(command.wait(), 130) << command.err();
  EXPECT_EQ(command.json()["ticks"], 200'000);
}

TEST(EndsTogether, WhatIsKeptOfARunWhoseProcessFailedSaysWhatItsExitStatusDoes) {
  for (const char* victim : {"mixloop-controller", "mixloop-planner"}) {
    SCOPED_TRACE(victim);
    const ScratchFolder folder;
    const std::string kept = folder.file("kept");
    Command command(long_run(kept));
    ASSERT_TRUE(eventually([&] { return bytes_of(kept + "/run.lcmlog").size() > 100'000; })) << command.err();
    kill(child_named(command, victim), SIGKILL);
    EXPECT_EQ(command.wait(), 3) << command.out();
    const auto result = nlohmann::json::parse(bytes_of(kept + "/result.json"));
    EXPECT_EQ(result["exit_status"], 3);
    EXPECT_EQ(result["verdict"], "fault");
    EXPECT_EQ(result["error"]["code"], "process_failed");
    EXPECT_THAT(result["error"]["message"].get<std::string>(),
                HasSubstr(std::string(victim) + " was killed"));
  }
}

}  // namespace
}  // namespace mixloop
