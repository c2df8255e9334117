// SPDX-License-Identifier: MIT
// Sweeps as a person starts, kills, splits and holds them.
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/terminal.hpp"

namespace mixloop {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

class SweepCommand : public testing::Test {
 protected:
  /// 1,500 runs of the paper's experiment: half a second of a core.
  std::vector<std::string> line(const std::string& folder, const std::vector<std::string>& more = {},
                                const std::string& runs = "1500") const {
    std::vector<std::string> words = {bin("mixloop"),
                                      "sweep",
                                      experiment("paper"),
                                      "--sample",
                                      "parameters.payload=normal(5 kg, 0.5 kg)",
                                      "--runs",
                                      runs,
                                      "--out",
                                      scratch.file(folder)};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::string table(const std::string& folder) const {
    return bytes_of(scratch.file(folder + "/table.csv")) + bytes_of(scratch.file(folder + "/table.h5"));
  }
  std::uintmax_t kept(const std::string& folder) const {
    std::error_code none;
    const auto size = std::filesystem::file_size(scratch.file(folder + "/journal"), none);
    return none ? 0 : size;
  }
  /// That of one that nobody disturbed, to compare with.
  std::string whole() const {
    Command command(line("whole"));
    EXPECT_EQ(command.wait(), 0) << command.err();
    return table("whole");
  }

  ScratchFolder scratch;
};

TEST_F(SweepCommand, KilledAndGoneOnWithThreeTimesHasTheSameTable) {
  std::uintmax_t before = 0;
  for (int i = 0; i < 3; ++i) {
    Command command(line("killed", {"--threads", i == 1 ? "1" : "2"}));
    ASSERT_TRUE(eventually([&] { return kept("killed") > before + 30'000; })) << command.err();
    command.signal(SIGKILL);
    EXPECT_EQ(command.wait(), 128 + SIGKILL) << "too short to be killed";
    before = kept("killed");
    EXPECT_EQ(table("killed"), "");
  }
  Command last(line("killed"));
  EXPECT_EQ(last.wait(), 0) << last.err();
  EXPECT_TRUE(table("killed") == whole());
}

TEST_F(SweepCommand, InterruptedSaysHowToGoOnAndKeepsWhatThereIs) {
  Command command(line("interrupted"));
  ASSERT_TRUE(eventually([&] { return kept("interrupted") > 10'000; })) << command.err();
  command.signal(SIGINT);
  EXPECT_EQ(command.wait(milliseconds(5000)), 130);
  EXPECT_THAT(command.out(), HasSubstr("interrupted; the same command goes on with the rest"));
  EXPECT_THAT(command.out(), Not(HasSubstr("1500 of 1500")));
}

TEST_F(SweepCommand, ShardsPutTogetherAreTheWhole) {
  const auto merge = line("split", {"--merge"});
  Command one(line("split", {"--shard", "1/2"}));
  EXPECT_EQ(one.wait(), 0) << one.err();
  EXPECT_THAT(one.out(), HasSubstr("--merge makes the table"));
  Command early(merge);
  EXPECT_EQ(early.wait(), 2);
  EXPECT_THAT(early.err(), HasSubstr("748 of 1500 runs are not there, the first is run 8"));
  Command two(line("split", {"--shard", "2/2"}));
  EXPECT_EQ(two.wait(), 0) << two.err();
  Command together(merge);
  EXPECT_EQ(together.wait(), 0) << together.err();
  EXPECT_TRUE(table("split") == whole());
}

/// Ranks of OpenMPI, which as root wants to be told that it may.
class SweepByMpi : public SweepCommand {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/bin/mpirun") || !MIXLOOP_HAS_MPI)
      GTEST_SKIP() << "no mpirun, or built without MPI: packages openmpi-bin, libopenmpi-dev";
  }
  std::vector<std::string> ranks(const std::string& folder, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"/usr/bin/mpirun", "-n", "2", "--oversubscribe"};
    words.insert(words.end(), more.begin(), more.end());
    for (const auto& word : line(folder, {"--patience", "2"})) words.push_back(word);
    return words;
  }
  /// A rank's process, a child of mpirun's.
  static int process_of(const Command& mpirun, int rank) {
    const std::string word = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
    for (const int child : mpirun.children())
      if (bytes_of("/proc/" + std::to_string(child) + "/environ").find(word + '\0') != std::string::npos)
        return child;
    return 0;
  }

  // OpenMPI keeps what it has to the end: leaks are looked for in ranks of one process.
  const std::vector<std::string> environment = {
      "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "ASAN_OPTIONS=detect_leaks=0"};
};

TEST_F(SweepByMpi, RanksComeToTheSameTable) {
  Command command(ranks("ranks", {}), environment);
  EXPECT_EQ(command.wait(), 0) << command.err();
  EXPECT_TRUE(table("ranks") == whole());
}

TEST_F(SweepByMpi, ARanksDeathIsToldAndItsRunsAreDone) {
  Command command(ranks("ranks", {"--enable-recovery"}), environment);
  ASSERT_TRUE(eventually([&] { return kept("ranks") > 5'000; })) << command.err();
  const int process = process_of(command, 1);
  ASSERT_GT(process, 0);
  kill(process, SIGKILL);
  EXPECT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.err(), HasSubstr("rank 1 (process " + std::to_string(process)));
  EXPECT_TRUE(table("ranks") == whole());
}

TEST_F(SweepCommand, TwoInOneFolderAndOtherSettingsThereAreRefused) {
  Command first(line("busy"));
  ASSERT_TRUE(eventually([&] { return kept("busy") > 0; })) << first.err();
  Command second(line("busy"));
  EXPECT_EQ(second.wait(), 2);
  EXPECT_THAT(second.err(), HasSubstr("process " + std::to_string(first.pid()) + " on "));
  first.signal(SIGKILL);
  first.wait();
  Command other(line("busy", {"--seed", "2"}));
  EXPECT_EQ(other.wait(), 2);
  EXPECT_THAT(other.err(), HasSubstr("seed: '1', and now '2' is asked for"));
}

// A small file system of its own, where the machine lets a command mount one.
TEST_F(SweepCommand, AFullDiskLosesNothing) {
  const std::string folder = scratch.file("small");
  std::filesystem::create_directory(folder);
  std::string words;
  for (const auto& word : line("small/out")) words += "'" + word + "' ";
  const std::string mounted = "mount -t tmpfs -o size=64k none '" + folder + "' || exit 77; ";
  Command command({"/usr/bin/unshare", "-rm", "sh", "-c",
                   mounted + words + "; test $? = 3 || exit 1; mount -o remount,size=16m '" + folder + "'; " +
                       words + "; cp -r '" + folder + "/out' '" + scratch.file("full") + "'"});
  const int status = command.wait();
  if (status == 77 || command.err().find("unshare failed") != std::string::npos)
    GTEST_SKIP() << "no file system may be mounted here: " << command.err();
  EXPECT_EQ(status, 0) << command.out() << command.err();
  EXPECT_THAT(command.err(), HasSubstr("No space left on device; what it keeps already is whole"));
  EXPECT_TRUE(table("full") == whole());
}

TEST_F(SweepCommand, AWrittenRunIsTheRun) {
  Command command({bin("mixloop"), "sweep", experiment("paper"), "--vary", "parameters.payload=0..5 kg:11",
                   "--hashes", "--out", scratch.file("out")});
  ASSERT_EQ(command.wait(), 0) << command.err();
  Command write({bin("mixloop"), "sweep", experiment("paper"), "--vary", "parameters.payload=0..5 kg:11",
                 "--write-run", "3", "--out", scratch.file(""), "--json"});
  ASSERT_EQ(write.wait(), 0) << write.err();
  Command simulate({bin("mixloop"), "simulate", write.json()["file"], "--json"});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  EXPECT_THAT(bytes_of(scratch.file("out/table.csv")), HasSubstr("\n3,1.5,held,"));
  EXPECT_THAT(bytes_of(scratch.file("out/table.csv")),
              HasSubstr(simulate.json()["trajectory_sha256"].get<std::string>()));
}

TEST_F(SweepCommand, ATestOfASuiteNamesTheWorstRunsCommand) {
  const std::string file = scratch.write("light.sweep.yaml", "experiment: " + experiment("paper") + R"(
set: {expect: {}}
vary: {parameters.payload: "0..5 kg:6"}
expect: [{share: 0.8, max_position_error: 12 mm}, {max_position_error: 12 mm}]
)");
  Command track({bin("mixloop"), "track", file, experiment("paper"), "--junit", scratch.file("junit.xml")});
  EXPECT_EQ(track.wait(), 1) << track.err();
  EXPECT_THAT(track.out(), HasSubstr("missed       light"));
  const std::string junit = bytes_of(scratch.file("junit.xml"));
  EXPECT_THAT(junit, HasSubstr("tests=\"2\" failures=\"1\""));
  EXPECT_THAT(junit, HasSubstr("only 83.3333 %; run 5: max_position_error is 13.2067 mm"));
  EXPECT_THAT(junit, HasSubstr("simulate " + experiment("paper") + " --set"));
  EXPECT_THAT(junit, HasSubstr("parameters.payload=5 kg"));
  EXPECT_THAT(junit, HasSubstr("<property name=\"max_position_error max [m]\" value=\"0.013206"));
}

TEST_F(SweepCommand, SaysOnATerminalHowFarItIsAndHowFast) {
  Terminal screen(line("shown", {"--threads", "1"}, "10000"), {"TERM=vt100"}, 24, 120);
  EXPECT_TRUE(screen.shows(" of 10000 runs (")) << screen.screen();
  EXPECT_THAT(screen.screen(), HasSubstr(" runs/s, "));
  screen.type("\x03");  // Ctrl-C
  EXPECT_EQ(screen.wait(milliseconds(5000)), 130);
}

TEST_F(SweepCommand, AGraphicsProcessorThatIsNotThereIsSaid) {
  auto words = line("kept", {"--device", "cuda", "--json"});
  words.insert(words.begin(), {"/usr/bin/env", "MIXLOOP_NVCC="});
  Command command(words);
  EXPECT_EQ(command.wait(), 3);
  const auto error = nlohmann::json::parse(command.out()).at("error");
  EXPECT_EQ(error.at("code"), "missing_part");
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("nvcc"));
}

TEST_F(SweepCommand, BadInputIsRefused) {
  const auto refused = [](std::vector<std::string> words, const char* code, const char* message) {
    words.insert(words.begin(), {"sweep", experiment("paper")});
    expect_refused(words, 2, code, message);
  };
  refused({}, "missing_key", "nothing is varied");
  refused({"--vary", "controller.kpp=1,2"}, "unknown_key", "did you mean 'kp'?");
  refused({"--vary", "seed=1,2", "--runs", "5"}, "missing_key", "nothing is sampled");
  refused({"--vary", "seed=1,2", "--shard", "3/2", "--out", "x"}, "out_of_range", "expected I/N");
  refused({"--vary", "seed=1,2", "--shard", "1/2"}, "missing_key", "expected --out FOLDER");
  refused({"--vary", "seed=1,2", "--write-run", "2"}, "out_of_range", "expected 0 to 1");
}

}  // namespace
}  // namespace mixloop
