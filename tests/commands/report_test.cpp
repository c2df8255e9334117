// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <fstream>

#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Whether web/ was built here: a machine without npm has no pages.
bool has_pages() { return MIXLOOP_HAS_PAGES; }

std::string simulated(const ScratchFolder& folder, const std::string& name) {
  const std::string out = folder.file(name);
  Command command({bin("mixloop"), "simulate", experiment("paper"), "--json", "--out", out});
  EXPECT_EQ(command.wait(), 0) << command.err();
  return out;
}

TEST(Report, IsOneFileOfAllResults) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string one = simulated(folder, "one"), two = simulated(folder, "two");
  Command command({bin("mixloop"), "report", one, two, "--out", folder.file("both.html"), "--json"});
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  const auto json = command.json();
  EXPECT_EQ(json["results"].size(), 2u);
  EXPECT_EQ(json["results"][0]["label"], "paper (one)");
  EXPECT_EQ(json["results"][1]["ticks"], 1001);
  const std::string page = bytes_of(folder.file("both.html"));
  EXPECT_EQ(page.size(), json["bytes"].get<std::size_t>());
  EXPECT_THAT(page, AllOf(HasSubstr("paper (two)"), HasSubstr("default-src 'none'")));
  EXPECT_THAT(page, testing::Not(testing::ContainsRegex("(src|href)=\"?http")));
}

TEST(Report, SaysWhyARunEndedEarlyAndWhatItsPlantDropped) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string one = simulated(folder, "one");
  auto result = nlohmann::json::parse(bytes_of(one + "/result.json"));
  result["error"] = {{"code", "lost_peer"}, {"message", "no answer to tick 7"}, {"where", ""}};
  result["rejected_by_cause"] = {{"not_finite", 67}, {"stale", 5}, {"session", 0}};
  std::ofstream(one + "/result.json") << result;
  Command command({bin("mixloop"), "report", one, "--json"});
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  EXPECT_THAT(command.json()["results"][0]["notes"].dump(),
              AllOf(HasSubstr("The run ended by a fault: no answer to tick 7."),
                    HasSubstr("The plant dropped messages: 67 not_finite.")));
}

TEST(Report, StandsInTheResultsFolder) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string one = simulated(folder, "one");
  Command command({bin("mixloop"), "report", one});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.out(), HasSubstr(one + "/report.html"));
  EXPECT_TRUE(std::filesystem::exists(one + "/report.html"));
}

// The scene comes from inputs.json beside the log, or from the experiment that is named.
TEST(Report, TakesALog) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string out = folder.file("run");
  Command run({bin("mixloop"), "run", experiment("paper"), "--json", "--out", out});
  ASSERT_EQ(run.wait(), 0) << run.err();
  std::filesystem::copy_file(out + "/run.lcmlog", folder.file("alone.lcmlog"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{out},
        {out + "/run.lcmlog"},
        {folder.file("alone.lcmlog")},
        {folder.file("alone.lcmlog"), "--experiment", experiment("paper")}}) {
    SCOPED_TRACE(words.back());
    std::vector<std::string> all = {bin("mixloop"), "report", "--json", "--out", folder.file("page.html")};
    all.insert(all.end(), words.begin(), words.end());
    Command command(all);
    ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
    EXPECT_EQ(command.json()["results"][0]["ticks"], 1001);
    const bool knows_scene = words.front() != folder.file("alone.lcmlog") || words.size() > 1;
    EXPECT_EQ(bytes_of(folder.file("page.html")).find("\"q_1\":") != std::string::npos, knows_scene);
  }
}

TEST(Report, RefusesWhatIsNoResult) {
  ScratchFolder folder;
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  expect_refused({"report", folder.path().string()}, 2, "not_a_result", "no result.json");
  expect_refused({"report", folder.file("nothing")}, 2, "cannot_read", "no such file");
  expect_refused({"report", folder.write("text", "hello, log")}, 2, "not_a_log", "LCM event log");
  expect_refused({"report", folder.file("x"), "--set", "rate=1"}, 2, "command_line", "--experiment");
  const std::string one = simulated(folder, "one");
  std::ofstream(one + "/inputs.json") << "{}";
  expect_refused({"report", one}, 2, "missing_key", "'scene'");
  std::ofstream(one + "/result.json") << "[1";
  std::filesystem::remove(one + "/inputs.json");
  expect_refused({"report", one}, 2, "not_a_result", "no JSON object");
}

/// A kept result in which somebody has written since.
struct Changed {
  const char* file;
  const char* key;
  const char* to;
  const char* code;
};

TEST(Report, RefusesAKeptEntryOfAnotherKindAtItsPlace) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  const ScratchFolder folder;
  const std::string kept = simulated(folder, "one");
  for (const Changed& changed : {Changed{"result.json", "rate", R"("fast")", "wrong_kind"},
                                 {"result.json", "rate", "-1", "out_of_range"},
                                 {"result.json", "experiment", "7", "wrong_kind"},
                                 {"result.json", "error", R"("lost")", "wrong_kind"},
                                 {"result.json", "rejected_by_cause", "[1]", "wrong_kind"},
                                 {"inputs.json", "rate", "[]", "wrong_kind"},
                                 {"inputs.json", "rate", "0", "out_of_range"},
                                 {"inputs.json", "plant_parameters", "3", "wrong_kind"},
                                 {"inputs.json", "plant_parameters", R"({"payload": "5 kg"})", "wrong_kind"},
                                 {"inputs.json", "limits", "3", "wrong_kind"},
                                 {"inputs.json", "faults", "{}", "wrong_kind"},
                                 {"inputs.json", "faults", "[3]", "wrong_kind"},
                                 {"inputs.json", "name", "[1]", "wrong_kind"},
                                 {"inputs.json", "scene", "3", "wrong_kind"}}) {
    SCOPED_TRACE(std::string(changed.file) + ", " + changed.key + ": " + changed.to);
    const std::string path = kept + "/" + changed.file, before = bytes_of(path);
    auto json = nlohmann::json::parse(before);
    json[changed.key] = nlohmann::json::parse(changed.to);
    std::ofstream(path) << json;
    Command command({bin("mixloop"), "report", kept, "--json"});
    EXPECT_EQ(command.wait(), 2) << command.out();
    const auto error = command.json()["error"];
    EXPECT_EQ(error["code"], changed.code);
    EXPECT_THAT(error["where"].get<std::string>(), testing::StartsWith(path));
    EXPECT_THAT(error["message"].get<std::string>(), HasSubstr(changed.key));
    std::ofstream(path) << before;
  }
}

TEST(Report, SaysWhereItCannotWrite) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string one = simulated(folder, "one");
  expect_refused({"report", one, "--out", folder.file("no/such/folder.html")}, 3, "cannot_write",
                 "no/such/folder.html");
}

}  // namespace
}  // namespace mixloop
