// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

Command replayed(const std::string& log, std::initializer_list<std::string> more = {}) {
  std::vector<std::string> words = {bin("mixloop"), "replay", experiment("paper"), log, "--json"};
  words.insert(words.end(), more);
  return Command(words);
}

TEST(Replay, GivesALogsCommandsByteForByte) {
  const ScratchFolder folder;
  for (const char* how : {"--lockstep", "--realtime"}) {
    SCOPED_TRACE(how);
    Command run({bin("mixloop"), "run", experiment("paper"), how, "--speed", "1", "--json", "--out",
                 folder.file(how), "--set", "limits.position_error=1 m"});
    const int status = run.wait();
    auto replay = replayed(folder.file(std::string(how) + "/run.lcmlog"));
    EXPECT_EQ(replay.wait(), 0) << replay.out() << replay.err() << status << run.out() << run.err();
    const auto result = replay.json();
    EXPECT_EQ(result["identical"], result["commands"]);
    EXPECT_GT(result["commands"], 100) << "a busy machine misses some in real time";
  }
}

TEST(Replay, FindsTheFirstCommandOfAnotherLaw) {
  const ScratchFolder folder;
  Command run(
      {bin("mixloop"), "run", experiment("paper"), "--json", "--speed", "2", "--out", folder.file("kept")});
  ASSERT_EQ(run.wait(), 0) << run.err();
  auto replay = replayed(folder.file("kept/run.lcmlog"), {"--set", "controller.kp=[100, 25, 26]"});
  EXPECT_EQ(replay.wait(), 1);
  EXPECT_EQ(replay.json()["verdict"], "missed");
  EXPECT_GE(replay.json()["first_difference"], 0);
  auto stranger = replayed(folder.file("kept/run.lcmlog"), {"--set", "path.duration=2 s"});
  EXPECT_EQ(stranger.wait(), 2) << "another experiment's log";
  EXPECT_THAT(stranger.json()["error"]["message"].get<std::string>(),
              testing::HasSubstr("another experiment: its path"));
}

/// An event as LCM logs it.
std::string logged_as(const std::string& channel, const std::string& data) {
  std::string text = "\xED\xA1\xDA\x01" + std::string(16, '\0');
  for (const std::size_t size : {channel.size(), data.size()})
    text += std::string(3, '\0') + static_cast<char>(size);
  return text + channel + data;
}

TEST(Replay, SaysWhyALogHasNoCommandForIt) {
  const ScratchFolder folder;
  for (const auto& [channel, message] :
       {std::pair{"MIXLOOP_COMMAND", "another type than mixloop_lcm.command_t"},
        {"SOMEBODYS_COMMAND", "no message on MIXLOOP_COMMAND"}}) {
    auto replay = replayed(folder.write(channel, logged_as(channel, std::string(60, 'x'))));
    EXPECT_EQ(replay.wait(), 2);
    EXPECT_EQ(replay.json()["error"]["code"], "no_commands");
    EXPECT_THAT(replay.json()["error"]["message"].get<std::string>(), testing::HasSubstr(message));
  }
}

}  // namespace
}  // namespace mixloop
