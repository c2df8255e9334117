// SPDX-License-Identifier: MIT
// Suites: cases, baselines, many at once.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Suite : public testing::Test {
 protected:
  std::vector<std::string> track(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {bin("mixloop"), "track", cases, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  ScratchFolder inputs, scratch;
  /// A tenth of a second near the start of the paper's line, with an empty and a full hand.
  const std::string cases = inputs.write("hands.yaml", std::string("base: ") + experiment("paper") + R"(
path: {line: {from: [0.3, 0.0, 0.8], to: [0.29, 0.01, 0.79]}, duration: 0.1 s}
expect:
cases: {parameters.payload: {empty: 0 kg, full: 5 kg}}
)");
};

TEST_F(Suite, RunsEveryCaseAndGivesWhatSimulateGivesOfIt) {
  Command command(track({"--jobs", "2", "--out", scratch.file("out"), "--junit", scratch.file("junit.xml")}));
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  const auto results = command.json()["results"];
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0]["experiment"], "hands[payload=empty]");
  EXPECT_EQ(results[1]["experiment"], "hands[payload=full]");
  EXPECT_NE(results[0]["trajectory_sha256"], results[1]["trajectory_sha256"]);
  EXPECT_TRUE(std::filesystem::exists(scratch.file("out/hands[payload=full]/trajectory.csv")));
  const std::string junit = bytes_of(scratch.file("junit.xml"));
  EXPECT_THAT(junit, HasSubstr("name=\"hands[payload=empty]\""));
  EXPECT_THAT(junit, HasSubstr("<property name=\"max_torque[2] [N m]\" value=\""));

  Command simulate({bin("mixloop"), "simulate", cases, "--case", "payload=full", "--json"});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  EXPECT_EQ(simulate.json()["experiment"], "hands[payload=full]");
  EXPECT_EQ(simulate.json()["trajectory_sha256"], results[1]["trajectory_sha256"]);
  Command run({bin("mixloop"), "run", cases, "--case", "payload=full", "--json"});
  ASSERT_EQ(run.wait(), 0) << run.err();
  EXPECT_EQ(run.json()["trajectory_sha256"], results[1]["trajectory_sha256"]);
}

TEST_F(Suite, NamesAreDistinct) {
  Command command({bin("mixloop"), "track", cases, cases, "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  std::vector<std::string> names;
  const auto results = command.json()["results"];
  for (const auto& result : results)
    names.push_back(std::filesystem::path(result["experiment"].get<std::string>()).filename());
  EXPECT_THAT(names, ElementsAre("hands[payload=empty]", "hands[payload=full]", "hands[payload=empty] #2",
                                 "hands[payload=full] #2"));
}

TEST_F(Suite, WorseThanLastTimeFails) {
  const std::string baseline = scratch.file("last.json");
  Command first(track({"--baseline", baseline}));
  ASSERT_EQ(first.wait(), 0) << first.err();
  const auto kept = nlohmann::json::parse(bytes_of(baseline));
  EXPECT_EQ(kept.at("hands[payload=full]").at("max_position_error"),
            first.json()["results"][1]["max_position_error"]);
  Command same(track({"--baseline", baseline}));
  EXPECT_EQ(same.wait(), 0) << same.out();

  // As if it had been better by a tenth last time.
  auto better = kept;
  auto& error = better["hands[payload=full]"]["max_position_error"];
  error = 0.9 * error.get<double>();
  std::ofstream(baseline) << better;
  Command worse(track({"--baseline", baseline}));
  EXPECT_EQ(worse.wait(), 1);
  EXPECT_EQ(worse.json()["results"][0]["verdict"], "held");
  EXPECT_EQ(worse.json()["results"][1]["verdict"], "missed");
  EXPECT_THAT(worse.json()["results"][1]["missed"][0].get<std::string>(),
              testing::AllOf(HasSubstr("max_position_error"), HasSubstr("expected at most 5 % more")));
  EXPECT_EQ(nlohmann::json::parse(bytes_of(baseline)), better) << "what is worse is not kept";
  Command allowed(track({"--baseline", baseline, "--worse", "0.2"}));
  EXPECT_EQ(allowed.wait(), 0) << allowed.out();
  EXPECT_EQ(nlohmann::json::parse(bytes_of(baseline)), kept);
}

TEST_F(Suite, WhatIsNoBaselineOrNoCaseIsRefused) {
  Command baseline(track({"--baseline", cases}));
  EXPECT_EQ(baseline.wait(), 2);
  EXPECT_EQ(baseline.json()["error"]["code"], "not_a_baseline");
  Command command({bin("mixloop"), "simulate", cases, "--case", "payload=ful", "--json"});
  EXPECT_EQ(command.wait(), 2);
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(),
              HasSubstr("did you mean 'payload=full'?"));
}

}  // namespace
}  // namespace mixloop
