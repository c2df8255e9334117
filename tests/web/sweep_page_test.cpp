// SPDX-License-Identifier: MIT
#include "tests/web/look.hpp"

namespace mixloop {
namespace {

TEST(SweepPage, ShowsInABrowserWhatTheTableHolds) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  Command sweep({bin("mixloop"), "sweep", experiment("paper"), "--sample",
                 "parameters.payload=normal(5 kg, 0.5 kg)", "--sample",
                 "plant.command_delay=uniform(0, 300 us)", "--runs", "600", "--json", "--out", out});
  ASSERT_EQ(sweep.wait(), 0) << sweep.err();
  Command report({bin("mixloop"), "report", out});
  ASSERT_EQ(report.wait(), 0) << report.err();
  RecordProperty("times", look("sweep.mjs", {out + "/report.html", out + "/table.csv"}));
}

}  // namespace
}  // namespace mixloop
