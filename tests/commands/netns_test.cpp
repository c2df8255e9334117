// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

TEST(Netns, GivesACommandARouteForMulticastAndNoOther) {
  Command command({bin("mixloop"), "netns", "cat", "/proc/net/route"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.out(), testing::ContainsRegex("\nlo\t000000E0\t"));  // 224.0.0.0
  EXPECT_EQ(std::ranges::count(command.out(), '\n'), 2) << command.out();
}

TEST(Netns, PassesOptionsAndExitStatusOn) {
  Command command({bin("mixloop"), "netns", bin("mixloop"), "run", experiment("must_diverge"), "--json"});
  EXPECT_EQ(command.wait(), 3);
  EXPECT_TRUE(command.json().contains("diverged_at")) << command.out();
}

TEST(Netns, SaysWhatCannotBeStarted) {
  Command command({bin("mixloop"), "netns", "/no/such/command"});
  EXPECT_EQ(command.wait(), 2);
  EXPECT_THAT(command.err(), HasSubstr("cannot start '/no/such/command': No such file or directory"));
  Command none({bin("mixloop"), "netns"});
  EXPECT_EQ(none.wait(), 2);
  EXPECT_THAT(none.err(), HasSubstr("no command"));
}

// Help's examples are commands that work from where one stands.
TEST(AsCalled, HelpNamesOurCommandsByWhatTheShellFinds) {
  Command far({bin("mixloop"), "run", "--help"}, {"PATH=/usr/bin:/bin"});
  ASSERT_EQ(far.wait(), 0);
  EXPECT_THAT(far.out(), HasSubstr("bin/mixloop netns"));
  EXPECT_THAT(far.out(), testing::Not(HasSubstr(" mixloop run")));
  const std::string folder = std::filesystem::canonical(bin("mixloop")).parent_path();
  Command near({bin("mixloop"), "run", "--help"}, {"PATH=" + folder + ":/usr/bin:/bin"});
  ASSERT_EQ(near.wait(), 0);
  EXPECT_THAT(near.out(), HasSubstr("  mixloop netns mixloop run experiments/paper.yaml"));
}

// Away from a clone the files are those that are installed beside the command.
TEST(AsCalled, HelpNamesInstalledFilesWhereThereAreNoOthers) {
  const ScratchFolder folder;
  const std::string usr = folder.file("usr");
  std::filesystem::create_directories(usr + "/bin");
  std::filesystem::create_directories(usr + "/share/mixloop");
  std::filesystem::create_directory_symlink(MIXLOOP_SOURCE "/experiments",
                                            usr + "/share/mixloop/experiments");
  std::filesystem::copy(bin("mixloop"), usr + "/bin/mixloop");
  Command command({"/bin/sh", "-c", "cd / && exec mixloop simulate --help"},
                  {"PATH=" + usr + "/bin:/usr/bin:/bin"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.out(), HasSubstr("  mixloop simulate " +
                                       std::filesystem::canonical(MIXLOOP_SOURCE "/experiments").string() +
                                       "/paper.yaml\n"));
}

}  // namespace
}  // namespace mixloop
