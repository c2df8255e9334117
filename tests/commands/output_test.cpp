// SPDX-License-Identifier: MIT
// What can't be written is an error, of whichever command and file; a reader that has gone is none.
#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// By a shell, `mixloop` standing for the program.
struct Shell : Command {
  explicit Shell(const std::string& line)
      : Command({"/bin/sh", "-c", "mixloop() { " + bin("mixloop") + " \"$@\"; }; " + line}) {}
};

TEST(Output, ToAFullDeviceIsAnErrorOfEveryCommand) {
  const std::string paper = experiment("paper");
  const std::vector<std::string> lines = {"mixloop --version",
                                          "mixloop --help",
                                          "mixloop simulate --help",
                                          "mixloop simulate " + paper,
                                          "mixloop simulate --json " + paper,
                                          "mixloop track " + paper,
                                          "mixloop track --json " + paper,
                                          "mixloop dynamics " + robot(),
                                          "mixloop explain " + robot(),
                                          "mixloop explain --json " + robot(),
                                          "mixloop compile --emit cpp " + robot(),
                                          "mixloop simulate --json nothing.yaml",
                                          "mixloop simulate --json --no-such-option",
                                          bin("mixloop-plant") + " --help",
                                          bin("mixloop-planner") + " --help",
                                          bin("mixloop-controller") + " --help"};
  for (const std::string& line : lines) {
    Shell shell(line + " > /dev/full");
    EXPECT_EQ(shell.wait(), 3) << line;
    EXPECT_THAT(shell.err(), HasSubstr("stdout can't be written: No space left on device")) << line;
  }
}

TEST(Output, OfWhichNobodyReadsTheRestIsNoError) {
  Shell head("mixloop explain " + robot() + " | head -1");
  EXPECT_EQ(head.wait(), 0);
  EXPECT_THAT(head.err(), IsEmpty());
  Shell ignored("trap '' PIPE; mixloop explain " + robot() + " | true");
  EXPECT_EQ(ignored.wait(), 0);
  EXPECT_THAT(ignored.err(), IsEmpty());
}

// Else the first file that is opened would be stdout.
TEST(Output, ThatWasClosedNeverBecomesALogOrAResult) {
  for (const char* closed : {">&-", "<&- >&- 2>&-", "2>&-"}) {
    const ScratchFolder folder;
    for (const std::string& line :
         {"mixloop run " + experiment("paper"), "mixloop simulate " + experiment("paper")}) {
      SCOPED_TRACE(line + " " + closed);
      Shell shell(line + " --out " + folder.file("kept") + " " + closed);
      EXPECT_EQ(shell.wait(), 0) << shell.out() << shell.err();
      for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "kept"))
        EXPECT_EQ(bytes_of(entry.path().string()).find(": held"), std::string::npos) << entry.path();
      EXPECT_EQ(nlohmann::json::parse(bytes_of(folder.file("kept/result.json")))["exit_status"], 0);
    }
    EXPECT_EQ(bytes_of(folder.file("kept/trajectory.csv")).substr(0, 2), "t,");
  }
}

TEST(Output, IntoAFileThatIsFullIsAnError) {
  const ScratchFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.file("full.svg"));
  for (const std::string& line : {"mixloop track --junit /dev/full " + experiment("paper"),
                                  "mixloop stability --no-confirmation --poses 2 --picture " +
                                      folder.file("full.svg") + " " + experiment("paper"),
                                  "mixloop compile --emit cpp --file /dev/full " + robot()}) {
    Shell shell(line);
    EXPECT_EQ(shell.wait(), 3) << line << shell.out();
    EXPECT_THAT(shell.err(), HasSubstr("No space left on device")) << line;
  }
}

TEST(Output, OfTheBusIntoALogThatIsFullIsAnError) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.file("kept"));
  std::filesystem::create_symlink("/dev/full", folder.file("kept/run.lcmlog"));
  Shell shell("mixloop run --out " + folder.file("kept") + " " + experiment("paper"));
  EXPECT_EQ(shell.wait(), 3);
  EXPECT_THAT(shell.err(),
              HasSubstr("cannot write " + folder.file("kept/run.lcmlog") + ": No space left on device"));
}

TEST(Output, ThatEndsHalfWayLeavesNoHalf) {
  const ScratchFolder folder;
  Shell shell("trap '' XFSZ; ulimit -f 16; mixloop simulate --evaluation reference " + experiment("paper") +
              " --out " + folder.file("kept"));
  EXPECT_EQ(shell.wait(), 3);
  EXPECT_THAT(shell.err(),
              HasSubstr("cannot write " + folder.file("kept/trajectory.csv") + ": File too large"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.file("kept")));
}

}  // namespace
}  // namespace mixloop
