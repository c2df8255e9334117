// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/tools/paths.hpp"

namespace mixloop {
namespace {

// web/test/report.mjs says what is looked at.
TEST(ReportPage, ShowsInABrowserWhatTheTrajectoryHolds) {
  ScratchFolder folder;
  const std::string out = folder.file("paper");
  Command simulate({bin("mixloop"), "simulate", experiment("paper"), "--json", "--out", out});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  Command report({bin("mixloop"), "report", out});
  ASSERT_EQ(report.wait(), 0) << report.err();
  Command look({MIXLOOP_NODE, std::string(MIXLOOP_WEB_TESTS) + "/report.mjs", MIXLOOP_CHROMIUM, out + "/report.html",
                out + "/trajectory.csv"});
  EXPECT_EQ(look.wait(std::chrono::seconds(280)), 0) << look.out() << look.err();
}

}  // namespace
}  // namespace mixloop
