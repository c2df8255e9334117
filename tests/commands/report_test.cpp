// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

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

int refused(const std::vector<std::string>& words, const std::string& code, const std::string& message) {
  std::vector<std::string> all = {bin("mixloop"), "report", "--json"};
  all.insert(all.end(), words.begin(), words.end());
  Command command(all);
  const int status = command.wait();
  EXPECT_EQ(command.json()["error"]["code"], code) << command.out();
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), HasSubstr(message));
  return status;
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
  EXPECT_EQ(refused({folder.path().string()}, "not_a_result", "no result.json"), 2);
  EXPECT_EQ(refused({folder.file("nothing")}, "cannot_read", "no such file"), 2);
  EXPECT_EQ(refused({folder.write("text", "hello, log")}, "not_a_log", "LCM event log"), 2);
  EXPECT_EQ(refused({folder.file("x"), "--set", "rate=1"}, "command_line", "--experiment"), 2);
  const std::string one = simulated(folder, "one");
  std::ofstream(one + "/inputs.json") << "{}";
  EXPECT_EQ(refused({one}, "missing_key", "'scene'"), 2);
  std::ofstream(one + "/result.json") << "[1";
  std::filesystem::remove(one + "/inputs.json");
  EXPECT_EQ(refused({one}, "not_a_result", "no JSON object"), 2);
}

TEST(Report, SaysWhereItCannotWrite) {
  if (!has_pages()) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  const std::string one = simulated(folder, "one");
  EXPECT_EQ(
      refused({one, "--out", folder.file("no/such/folder.html")}, "cannot_write", "no/such/folder.html"), 3);
}

}  // namespace
}  // namespace mixloop
