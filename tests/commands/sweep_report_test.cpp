// SPDX-License-Identifier: MIT
// The page of a sweep, as a person asks for it.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class SweepReport : public testing::Test {
 protected:
  void SetUp() override {
    if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  }
  /// 200 runs of the paper's experiment.
  void sweep(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {bin("mixloop"),
                                      "sweep",
                                      experiment("paper"),
                                      "--sample",
                                      "parameters.payload=normal(5 kg, 0.5 kg)",
                                      "--sample",
                                      "plant.command_delay=uniform(0, 300 us)",
                                      "--runs",
                                      "200",
                                      "--json",
                                      "--out",
                                      out};
    words.insert(words.end(), more.begin(), more.end());
    Command command(words);
    ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  }
  nlohmann::json reported() {
    Command command({bin("mixloop"), "report", out, "--json"});
    EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
    return command.json();
  }
  /// What the page shows.
  nlohmann::json data() const {
    const std::string page = bytes_of(out + "/report.html"), mark = "type=\"application/json\">";
    const std::size_t begin = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  }

  const ScratchFolder folder;
  const std::string out = folder.file("kept");
};

TEST_F(SweepReport, IsOneFileWithEachWorstRunsCommandWhichComesToTheSame) {
  ASSERT_NO_FATAL_FAILURE(sweep());
  const auto json = reported();
  EXPECT_EQ(json["file"], out + "/report.html");
  EXPECT_EQ(json["done"], 200);
  EXPECT_EQ(json["notes"].size(), 0U);
  const std::string page = bytes_of(out + "/report.html");
  EXPECT_EQ(page.size(), json["bytes"].get<std::size_t>());
  EXPECT_LT(page.size(), 1'500'000U);
  EXPECT_THAT(page, AllOf(HasSubstr("default-src 'none'"), HasSubstr("Leon Sorokin")));
  EXPECT_THAT(page, testing::Not(testing::ContainsRegex("(src|href)=\"?http")));
  const auto shown = data();
  EXPECT_EQ(shown["ends"][0]["runs"].get<int>() + shown["ends"][1]["runs"].get<int>(), 200) << "held, missed";
  const auto& worst = shown["worst"][0]["cases"][0];
  const auto summary = nlohmann::json::parse(bytes_of(out + "/summary.json"));
  EXPECT_EQ(worst["run"], summary["columns"]["max_position_error"]["run_of_max"]);
  const std::string simulate = worst["command"].get<std::string>().substr(std::string("mixloop").size());
  Command again({"/bin/sh", "-c", bin("mixloop") + simulate + " --json"});
  again.wait();
  EXPECT_EQ(again.json()["max_position_error"], worst["value"]) << again.out() << again.err();
}

TEST_F(SweepReport, OfAPartSaysWhatIsMissingAndHowToRunIt) {
  ASSERT_NO_FATAL_FAILURE(sweep({"--shard", "1/2"}));
  const auto json = reported();
  EXPECT_LT(json["done"], 200);
  EXPECT_THAT(json["notes"][0].get<std::string>(),
              AllOf(HasSubstr("of 200 runs are there"), HasSubstr("--sample"), HasSubstr("--out " + out)));
  EXPECT_EQ(data()["expect"].size(), 0U);
}

TEST_F(SweepReport, RefusesAFolderWithoutRunsOneOfAnEarlierVersionAndOneBesideOthers) {
  ASSERT_NO_FATAL_FAILURE(sweep());
  expect_refused({"report", out, folder.path().string()}, 2, "not_alone", "a page of its own");
  expect_refused({"report", experiment("paper"), out}, 2, "not_alone", "a page of its own");
  expect_refused({"report", out, "--session", "7"}, 2, "not_a_log", "without --session");
  std::string asked = bytes_of(out + "/asked.yaml");
  asked.replace(asked.find("\"columns\": ["), 12, "\"columns\": [[\"more\", \"m\"],");
  std::ofstream(out + "/asked.yaml") << asked;
  expect_refused({"report", out}, 2, "wrong_size", "not of the columns that asked.yaml names");
  std::filesystem::remove(out + "/journal");
  expect_refused({"report", out}, 2, "missing_runs", "none of its 200 runs is there yet; expected some: ");
  std::filesystem::remove(out + "/asked.yaml");
  expect_refused({"report", out}, 2, "no_such_file", "the same command in the same folder writes it");
}

TEST_F(SweepReport, ReadsWhatWasExpectedAndRefusesASummaryThatIsNone) {
  const std::string file = folder.write("a.sweep.yaml", "experiment: " + experiment("paper") +
                                                            "\nvary: {parameters.payload: 4..5 kg:2}\n"
                                                            "expect: [{max_position_error: 20 mm}]\n");
  Command command({bin("mixloop"), "sweep", file, "--out", out, "--json"});
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  reported();
  EXPECT_EQ(data()["expect"][0]["held"], true);
  EXPECT_EQ(data()["influences"][0]["entries"][0]["doubt"], 0) << "a grid";
  std::ofstream(out + "/summary.json") << R"({"expect": 7})";
  expect_refused({"report", out}, 2, "wrong_kind", "'expect'");
}

}  // namespace
}  // namespace mixloop
