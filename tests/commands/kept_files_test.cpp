// SPDX-License-Identifier: MIT
// What --out keeps is of one run.
#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

bool has_report() { return MIXLOOP_HAS_PAGES; }

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

void kept_by(std::vector<std::string> words, const std::string& out) {
  words.insert(words.begin(), bin("mixloop"));
  words.insert(words.end(), {experiment("paper"), "--set", "expect={}", "--json", "--out", out});
  Command command(words);
  EXPECT_NE(command.wait(), 2) << command.out()
                               << command.err();  // in real time a busy machine may bring the safe state
}

const std::vector<std::string> kSimulate = {"simulate"}, kRun = {"run"}, kRealTime = {"run", "--realtime"};

TEST(KeptFiles, OfAnEarlierRunAreReplacedAsOne) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  kept_by(kRealTime, out);
  EXPECT_THAT(names_in(out),
              ElementsAre("ages.csv", "inputs.json", "result.json", "run.lcmlog", "trajectory.csv"));
  std::ofstream(out + "/report.html") << "of that run";
  std::ofstream(out + "/notes.txt") << "a person's own";
  kept_by(kRun, out);
  EXPECT_THAT(names_in(out),
              ElementsAre("inputs.json", "notes.txt", "result.json", "run.lcmlog", "trajectory.csv"));
  kept_by(kSimulate, out);
  EXPECT_THAT(names_in(out), ElementsAre("inputs.json", "notes.txt", "result.json", "trajectory.csv"));
}

TEST(KeptFiles, OfAnEarlierRunStayWhereTheNewOneIsRefused) {
  const ScratchFolder folder;
  const std::string out = folder.file("kept");
  kept_by(kSimulate, out);
  const std::string before = bytes_of(out + "/result.json");
  Command command(
      {bin("mixloop"), "simulate", experiment("paper"), "--set", "path.line.to=[9, 9, 9]", "--out", out});
  EXPECT_EQ(command.wait(), 2);
  EXPECT_EQ(bytes_of(out + "/result.json"), before);
  EXPECT_EQ(names_in(out).size(), 3U);
}

TEST(KeptFiles, OfAnotherRunAreSaidToBe) {
  if (!has_report()) GTEST_SKIP() << "built without npm";
  const ScratchFolder folder;
  const std::string real_time = folder.file("real_time"), simulated = folder.file("simulated"),
                    run = folder.file("run");
  kept_by(kRealTime, real_time);
  kept_by(kSimulate, simulated);
  kept_by(kRun, run);
  for (const char* name : {"ages.csv", "run.lcmlog"})
    std::filesystem::copy_file(real_time + "/" + name, simulated + "/" + name);
  std::filesystem::copy_file(real_time + "/run.lcmlog", run + "/run.lcmlog",
                             std::filesystem::copy_options::overwrite_existing);
  const auto notes = [](const std::string& kept) {
    Command report({bin("mixloop"), "report", kept, "--json"});
    EXPECT_EQ(report.wait(), 0) << report.out();
    return report.json()["results"][0]["notes"].get<std::vector<std::string>>();
  };
  EXPECT_THAT(notes(simulated), AllOf(Contains(HasSubstr("ages.csv is of another run than result.json")),
                                      Contains(HasSubstr("run.lcmlog is of another run than result.json"))));
  EXPECT_THAT(notes(run), Contains(HasSubstr("run.lcmlog is of another run than result.json")));
  EXPECT_THAT(notes(real_time), testing::Not(Contains(HasSubstr("another run"))));

  std::filesystem::copy_file(simulated + "/trajectory.csv", real_time + "/trajectory.csv",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(notes(real_time), Contains(HasSubstr("trajectory.csv is of another run")));

  Command exported({bin("mixloop"), "export", run + "/run.lcmlog", "--json"});
  ASSERT_EQ(exported.wait(), 0);
  EXPECT_THAT(exported.json()["notes"][0].get<std::string>(), HasSubstr("another run"));
  Command replayed({bin("mixloop"), "replay", experiment("paper"), run + "/run.lcmlog", "--json"});
  replayed.wait();
  EXPECT_THAT(replayed.json()["note"].get<std::string>(), HasSubstr("another run"));
}

}  // namespace
}  // namespace mixloop
