// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "tests/support/mixed_motors.hpp"
#include "tests/web/look.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

/// A folder with a kept run and its page.
class ReportPage : public testing::Test {
 protected:
  void keep(const std::string& command, const std::vector<std::string>& options = {}) {
    std::vector<std::string> words = {bin("mixloop"), command, experiment("paper"), "--json", "--out", out};
    words.insert(words.end(), options.begin(), options.end());
    Command run(words);
    ASSERT_EQ(run.wait(), 0) << run.err();
    Command report({bin("mixloop"), "report", out});
    ASSERT_EQ(report.wait(), 0) << report.err();
  }

  ScratchFolder folder;
  std::string out = folder.file("paper"), page = out + "/report.html";
};

TEST_F(ReportPage, ShowsInABrowserWhatTheTrajectoryHolds) {
  ASSERT_NO_FATAL_FAILURE(keep("simulate"));
  look("report.mjs", {page, out + "/trajectory.csv"});
}

// More ticks than are drawn one by one.
TEST_F(ReportPage, PansALongRunOfFewPoints) {
  ASSERT_NO_FATAL_FAILURE(keep("simulate", {"--set", "path.duration=60 s", "--set", "expect={}"}));
  RecordProperty("rate", look("pan.mjs", {page}));
}

TEST_F(ReportPage, BeginsAComparisonWithWhatDiffers) {
  folder.write("scene.yaml", kMixedMotorsScene);
  const std::string mixed = folder.write("mixed.yaml", kMixedMotorsExperiment);
  const std::string one = folder.file("one"), two = folder.file("two");
  const std::vector<std::string> plain = {bin("mixloop"), "simulate", mixed, "--json", "--out"};
  std::vector<std::string> words = plain;
  words.push_back(one);
  Command first(words);
  ASSERT_EQ(first.wait(), 0) << first.out() << first.err();
  words = plain;
  words.insert(words.end(),
               {two, "--set", "plant={integrator: leapfrog, torque_limit: [20 N, 20 N m]}", "--set",
                "faults=[{at: 0.1 s, for: 0.05 s, motor: turn, kind: wrong, magnitude: 0.1 N m}]"});
  Command second(words);
  ASSERT_EQ(second.wait(), 0) << second.out() << second.err();
  Command report({bin("mixloop"), "report", one, two, "--out", page = folder.file("both.html")});
  ASSERT_EQ(report.wait(), 0) << report.err();
  look("compare.mjs", {page});
}

TEST_F(ReportPage, ShowsWhatThePlantSaidOfItsTiming) {
  ASSERT_NO_FATAL_FAILURE(keep("run", {"--speed", "1"}));
  look("timing.mjs", {page});
}

TEST_F(ReportPage, CarriesTheLicencesOfWhatItIsMadeOf) {
  ASSERT_NO_FATAL_FAILURE(keep("simulate"));
  const std::string report = bytes_of(page), view = bytes_of(bin("../share/mixloop/view.html"));
  for (const std::string& text : {report, view}) {
    EXPECT_THAT(text, HasSubstr("Leon Sorokin"));
    EXPECT_THAT(text,
                HasSubstr("The above copyright notice and this permission notice shall be included in"));
  }
  EXPECT_THAT(view, HasSubstr("three.js authors"));
}

}  // namespace
}  // namespace mixloop
