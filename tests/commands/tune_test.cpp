// SPDX-License-Identifier: MIT
// Tuning as a person asks for it, interrupts it and runs what it writes.
#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/terminal.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class TuneCommand : public testing::Test {
 protected:
  void SetUp() override {
    Command command({bin("mixloop"), "tune", experiment("paper"), "--json"});
    command.wait();
    if (command.json()["error"]["code"] == "missing_part")
      GTEST_SKIP() << "built without NLopt: package libnlopt-dev";
  }

  /// The paper's gains, at three instants of the path.
  std::vector<std::string> line(const std::vector<std::string>& more, const std::string& evaluations = "60",
                                const std::string& out = "tuned.yaml") const {
    std::vector<std::string> words = {bin("mixloop"),
                                      "tune",
                                      experiment("paper"),
                                      "--over",
                                      "controller.kp,controller.kv",
                                      "--minimise",
                                      "max_position_error",
                                      "--evaluations",
                                      evaluations,
                                      "--poses",
                                      "3",
                                      "--out",
                                      scratch.file(out)};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  ScratchFolder scratch;
};

TEST_F(TuneCommand, WritesAnExperimentThatShowsWhatItTold) {
  Command command(line({"--subject", "max_torque <= now", "--subject", "longest_delay >= now", "--json",
                        "--picture", scratch.file("tuned.svg")},
                       "120"));
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  const auto told = command.json();
  EXPECT_TRUE(told["feasible"] && told["improved"]);
  EXPECT_LT(told["goal"]["after"], 0.5 * told["goal"]["before"].get<double>());
  EXPECT_EQ(told["subject"].size(), 4U);

  Command simulate({bin("mixloop"), "simulate", told["file"], "--json"});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  EXPECT_EQ(simulate.json()["max_position_error"], told["goal"]["after"]);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(simulate.json()["max_torque"][i], told["subject"][i]["after"]);
  Command stability(
      {bin("mixloop"), "stability", told["file"], "--poses", "3", "--no-confirmation", "--json"});
  ASSERT_EQ(stability.wait(), 0) << stability.err();
  EXPECT_EQ(stability.json()["cases"][0]["along_path"]["longest_delay"], told["subject"][3]["after"]);
  EXPECT_THAT(bytes_of(told["file"]), HasSubstr("subject to longest_delay >= now"));
  EXPECT_THAT(bytes_of(scratch.file("tuned.svg")), HasSubstr("Position error of paper"));
}

TEST_F(TuneCommand, SaysTheSameEveryTime) {
  const auto said = [&](const char* threads) {
    Command command(line({"--subject", "longest_delay >= now", "--threads", threads}));
    EXPECT_EQ(command.wait(), 0) << command.err();
    return command.out() + bytes_of(scratch.file("tuned.yaml"));
  };
  const std::string first = said("1");
  EXPECT_THAT(first, HasSubstr("held, >= 0.00065"));
  EXPECT_EQ(said("2"), first);
}

TEST_F(TuneCommand, SaysOnATerminalHowFarItIsAndInterruptedWritesTheBestSoFar) {
  Terminal screen(line({"--subject", "longest_tick >= now", "--threads", "1"}, "1000000"), {"TERM=vt100"}, 24,
                  120);
  EXPECT_TRUE(screen.shows(" of 1000000 evaluations (")) << screen.screen();
  EXPECT_THAT(screen.screen(), HasSubstr("; best 0.0"));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("tuned.yaml")));
  screen.type("\x03");  // Ctrl-C
  EXPECT_EQ(screen.wait(milliseconds(10'000)), 130);
  EXPECT_THAT(screen.screen(), HasSubstr("this is the best of them"));
  EXPECT_THAT(bytes_of(scratch.file("tuned.yaml")), HasSubstr("paper.yaml tuned"));
}

TEST_F(TuneCommand, WritesNothingWhereNothingHoldsAllBounds) {
  Command command(line({"--subject", "max_position_error < 1e-9 m"}));
  EXPECT_EQ(command.wait(), 1) << command.err();
  EXPECT_THAT(command.out(), HasSubstr("nothing holds all bounds"));
  EXPECT_THAT(command.out(), HasSubstr("MISSED, < 1e-09"));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("tuned.yaml")));
}

TEST_F(TuneCommand, TakesASweepsFileAndWritesIntoAFolder) {
  Command command({bin("mixloop"), "tune", experiment("payload.sweep"), "--runs", "8", "--over",
                   "controller.kp[1]", "--minimise", "max_position_error", "--share", "0.9", "--evaluations",
                   "12", "--out", scratch.file("folder/")});
  EXPECT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.out(), HasSubstr("12 evaluations of 8 runs each"));
  EXPECT_TRUE(std::filesystem::exists(scratch.file("folder/paper.tuned.yaml")));
}

TEST_F(TuneCommand, BadInputIsRefused) {
  const auto refused = [](std::vector<std::string> words, const char* code, const char* message) {
    words.insert(words.begin(), {"tune", experiment("paper")});
    expect_refused(words, 2, code, message);
  };
  const std::vector<std::string> gains = {"--over", "controller.kp"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), gains.begin(), gains.end());
    return more;
  };
  refused({}, "missing_key", "nothing is tuned");
  refused(gains, "missing_key", "expected --minimise NAME or --maximise NAME");
  refused(with({"--minimise", "a", "--maximise", "b"}), "doubly_defined", "minimised already");
  refused(with({"--minimise", "energy_drift"}), "unknown_value", "isn't measured of this experiment");
  refused(with({"--minimise", "max_position_error", "--subject", "longest_dely > 1 ms"}), "unknown_value",
          "did you mean 'longest_delay'?");
  refused(with({"--minimise", "max_position_error", "--runs", "3"}), "missing_key", "nothing is sampled");
  refused(with({"--minimise", "max_position_error", "--picture", "tuned.pdf"}), "unknown_value",
          "ends in .svg or .png");
  refused(with({"--minimise", "max_position_error", "--out", experiment("paper")}), "file_exists",
          "is the experiment that is tuned");
  refused(with({"--minimise", "max_position_error", "--evaluations", "0"}), "command_line", "evaluations");
}

}  // namespace
}  // namespace mixloop
