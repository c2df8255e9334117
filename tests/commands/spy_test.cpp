// SPDX-License-Identifier: MIT
// lcm-spy itself, under Xvfb, beside a live run; a Java agent reads its table.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct Row {
  std::string type;
  double messages = 0, hz = 0, undecodable = 0;
};

/// The table by channel: channel, type, number, Hz, 1/Hz, jitter, bandwidth, undecodable.
std::map<std::string, Row> table_in(const std::string& file) {
  std::map<std::string, Row> rows;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string text; std::getline(cells, text, '\t');) cell.push_back(text);
    if (cell.size() == 8)
      rows[cell[0]] = {cell[1], std::stod(cell[2]), std::stod(cell[3]), std::stod(cell[7])};
  }
  return rows;
}

TEST(Spy, DecodesOurChannelsAtTheirRate) {
  const std::string probe = MIXLOOP_SPY_PROBE, display = ":" + std::to_string(1000 + getpid() % 30'000);
  if (probe.empty() || !std::filesystem::exists("/usr/bin/Xvfb"))
    GTEST_SKIP() << "no JDK, liblcm-java or Xvfb";
  ScratchFolder folder;
  Command screen({"/usr/bin/Xvfb", display, "-screen", "0", "1024x768x24", "-nolisten", "tcp"});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists("/tmp/.X11-unix/X" + display.substr(1)); }));
  Command spy({bin("mixloop"), "spy"},
              {"DISPLAY=" + display, "JAVA_TOOL_OPTIONS=-javaagent:" + probe + "=" + folder.file("table")});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.file("table")); }, 60s)) << spy.err();
  Command run({bin("mixloop"), "run", experiment("paper"), "--speed", "1", "--hold", "--truth"});

  // A busy machine slows lockstep down; the rate is held once the table has seen it.
  const std::map<std::string, std::string> types = {{"MIXLOOP_STATE", "state_t"},
                                                    {"MIXLOOP_REFERENCE", "reference_t"},
                                                    {"MIXLOOP_COMMAND", "command_t"},
                                                    {"MIXLOOP_TRUTH", "truth_t"}};
  std::map<std::string, Row> rows;
  EXPECT_TRUE(eventually(
      [&] {
        rows = table_in(folder.file("table"));
        return std::all_of(types.begin(), types.end(), [&](const auto& wanted) {
          const auto row = rows.find(wanted.first);
          return row != rows.end() && row->second.messages > 1000 && row->second.hz > 900;
        });
      },
      40s));
  for (const auto& [channel, type] : types) {
    SCOPED_TRACE(channel);
    EXPECT_EQ(rows[channel].type, type);
    EXPECT_EQ(rows[channel].undecodable, 0);
    EXPECT_LT(rows[channel].hz, 1100);
  }
  run.signal(SIGINT);
  run.wait();
}

TEST(Spy, SaysWhatItLacks) {
  Command spy({bin("mixloop"), "spy"}, {"DISPLAY"});  // putenv without a value takes it away
  EXPECT_EQ(spy.wait(), 3);
  EXPECT_THAT(spy.err(), testing::AnyOf(HasSubstr("DISPLAY is not set"), HasSubstr("is missing")));
}

}  // namespace
}  // namespace mixloop
