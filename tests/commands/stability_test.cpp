// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

TEST(Stability, FindsTheLimitsByItselfAndConfirmsThem) {
  ScratchFolder folder;
  Command command({bin("mixloop"), "stability", experiment("paper"), "--json", "--poses", "3", "--picture",
                   folder.file("map.svg")});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const auto result = command.json();
  ASSERT_EQ(result["cases"].size(), 2U);
  const auto& loaded = result["cases"][0];
  const auto& unloaded = result["cases"][1];
  EXPECT_NEAR(loaded["at_start"]["longest_delay"], 0.651e-3, 0.5e-6);
  EXPECT_NEAR(unloaded["at_start"]["longest_tick"], 1.006e-3, 0.5e-6);
  EXPECT_EQ(unloaded["set"]["parameters.payload"], "0 kg");
  for (const auto* limit : {"longest_delay", "longest_tick_without_delay"}) {
    EXPECT_EQ(loaded["confirmed"][limit]["below"], "decays") << limit;
    EXPECT_EQ(loaded["confirmed"][limit]["above"], "grows") << limit;
  }
  std::ifstream picture(folder.file("map.svg"));
  std::string svg(std::istreambuf_iterator<char>(picture), {});
  EXPECT_THAT(svg, HasSubstr("parameters.payload = 0 kg"));
}

TEST(Stability, SaysOneWhereTheExperimentIsUnstable) {
  Command command(
      {bin("mixloop"), "stability", experiment("must_diverge"), "--poses", "2", "--no-confirmation"});
  EXPECT_EQ(command.wait(), 1) << command.err();
  EXPECT_THAT(command.out(), HasSubstr("as it stands: unstable"));
}

TEST(Stability, VariesAnyEntry) {
  Command command({bin("mixloop"), "stability", experiment("paper"), "--json", "--poses", "2",
                   "--no-confirmation", "--vary", "controller.kp=[100, 25, 25],[50, 12, 12]", "--vary",
                   "rate=500 Hz,1 kHz"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const auto result = command.json();
  ASSERT_EQ(result["cases"].size(), 5U) << "as it stands and four";
  EXPECT_EQ(result["cases"][1]["verdict"], "unstable") << "500 Hz is past the longest tick";
  EXPECT_EQ(result["cases"][4]["set"]["controller.kp"], "[50, 12, 12]");
}

TEST(Stability, RefusesWhatItCannotDraw) {
  Command command({bin("mixloop"), "stability", experiment("paper"), "--poses", "2", "--no-confirmation",
                   "--picture", "map.pdf"});
  EXPECT_EQ(command.wait(), 2);
  EXPECT_THAT(command.err(), HasSubstr("ends in .svg or .png"));
}

TEST(Stability, IsWarnedOfBeforeARun) {
  Command command({bin("mixloop"), "simulate", experiment("no_payload")});
  EXPECT_EQ(command.wait(), 0);
  EXPECT_THAT(command.err(), HasSubstr("warning: the sampled loop is near its limit"));
}

}  // namespace
}  // namespace mixloop
