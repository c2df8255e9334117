// SPDX-License-Identifier: MIT
// `mixloop run`: three processes over LCM, on good and on bad days.
#include <gmock/gmock.h>

#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <optional>
#include <random>

#include "tests/support/bad_network.hpp"
#include "tests/support/command.hpp"
#include "tests/support/heard.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

std::string simulated_hash() {
  static const std::string hash = [] {
    Command command({bin("mixloop"), "simulate", experiment("paper"), "--json"});
    EXPECT_EQ(command.wait(), 0) << command.err();
    return command.json()["trajectory_sha256"].get<std::string>();
  }();
  return hash;
}

std::vector<std::string> run_line(std::initializer_list<std::string> more = {}) {
  std::vector<std::string> words = {bin("mixloop"), "run", experiment("paper"), "--json"};
  words.insert(words.end(), more);
  return words;
}

void expect_the_simulated_bytes(Command& command) {
  ASSERT_EQ(command.wait(), 0) << command.out() << command.err();
  EXPECT_EQ(command.json()["trajectory_sha256"], simulated_hash());
  EXPECT_EQ(command.json()["ticks"], 1000);
}

TEST(Run, GivesTheSimulatedBytesWhenIdle) {
  for (int i = 0; i < 4; ++i) {
    Command command(run_line());
    expect_the_simulated_bytes(command);
  }
}

// The peers leave before the plant has written what it recorded: here for want of a reader.
TEST(Run, WaitsAsLongAsItTakesToKeepTheResults) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "kept");
  const std::string fifo = folder.file("kept/trajectory.csv");
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  Command command(run_line({"--out", folder.file("kept")}));
  std::this_thread::sleep_for(std::chrono::seconds(8));  // past both graces
  ASSERT_TRUE(command.running()) << command.err();
  std::ifstream reader(fifo);
  std::size_t lines = 0;
  for (std::string line; std::getline(reader, line);) ++lines;
  EXPECT_EQ(lines, 1002U);
  expect_the_simulated_bytes(command);
}

TEST(Run, GivesTheSimulatedBytesByOtherIntegratorsToo) {
  for (const char* plant : {"plant.integrator=auto", "plant.integrator=rodas4",
                            "plant={integrator: dop853, local_error: 1e-9, command_delay: 0.3 ms}"}) {
    SCOPED_TRACE(plant);
    Command alone({bin("mixloop"), "simulate", experiment("paper"), "--json", "--set", plant}),
        bus({bin("mixloop"), "run", experiment("paper"), "--json", "--set", plant});
    ASSERT_EQ(alone.wait(), 0) << alone.err();
    ASSERT_EQ(bus.wait(), 0) << bus.err();
    EXPECT_EQ(bus.json()["trajectory_sha256"], alone.json()["trajectory_sha256"]);
    EXPECT_EQ(bus.json()["integrator"], alone.json()["integrator"]);
  }
}

TEST(Run, GivesTheSimulatedBytesUnderLoad) {
  std::vector<std::unique_ptr<Command>> load;
  for (int i = 0; i < 4; ++i)
    load.push_back(
        std::make_unique<Command>(std::vector<std::string>{"/bin/sh", "-c", "while :; do :; done"}));
  for (int i = 0; i < 3; ++i) {
    Command command(run_line());
    expect_the_simulated_bytes(command);
  }
}

TEST(Run, GivesTheSimulatedBytesOnABadNetwork) {
  for (int seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    Command command(run_line(), bad_network(seed));
    expect_the_simulated_bytes(command);
    EXPECT_GT(command.json()["resent"], 0);
  }
}

TEST(Run, GivesTheSimulatedBytesInAllSixStartOrders) {
  std::vector<std::string> names = {"controller", "planner", "plant"};
  do {
    Command command(run_line({"--order", names[0] + "," + names[1] + "," + names[2]}));
    SCOPED_TRACE(names[0] + names[1] + names[2]);
    expect_the_simulated_bytes(command);
  } while (std::next_permutation(names.begin(), names.end()));
}

TEST(Run, GivesTheSimulatedBytesWithProcessesStoppedAndContinued) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Command command(run_line({"--speed", "2"}));
    for (int i = 0; i < 12 && command.running(); ++i) {
      const auto children = command.children();
      if (children.empty()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        continue;
      }
      const int pid = children[random() % children.size()];
      kill(pid, SIGSTOP);
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 40));
      kill(pid, SIGCONT);
    }
    expect_the_simulated_bytes(command);
  }
}

TEST(Run, KeepsResultTrajectoryAndLog) {
  ScratchFolder folder;
  Command command(run_line({"--speed", "1", "--truth", "--out", folder.file("kept")}));
  expect_the_simulated_bytes(command);
  for (const char* file : {"result.json", "trajectory.csv", "run.lcmlog"})
    EXPECT_GT(std::filesystem::file_size(folder.path() / "kept" / file), 500U) << file;
  EXPECT_GT(command.json()["log"]["events"], 3000);
}

TEST(Run, RefusesContinuousControlAndAnImpossiblePathBeforeItStarts) {
  Command continuous({bin("mixloop"), "run", experiment("paper_continuous"), "--json"});
  EXPECT_EQ(continuous.wait(), 2);
  EXPECT_THAT(continuous.json()["error"]["message"].get<std::string>(), HasSubstr("continuous"));
  Command unreachable(run_line({"--set", "path.line.to=[1, 1, 1]"}));
  EXPECT_EQ(unreachable.wait(), 2);
}

TEST(Run, ReportsDivergenceAndPublishesNothingOfIt) {
  ScratchFolder folder;
  Command command(run_line({"--set", "plant.command_delay=1 ms", "--out", folder.file("kept")}));
  EXPECT_EQ(command.wait(), 3) << command.err();
  const auto result = command.json();
  EXPECT_EQ(result["verdict"], "diverged");
  Command simulated(
      {bin("mixloop"), "simulate", experiment("paper"), "--json", "--set", "plant.command_delay=1 ms"});
  EXPECT_EQ(simulated.wait(), 3);
  EXPECT_EQ(result["diverged_at"], simulated.json()["diverged_at"]);
  EXPECT_EQ(result["trajectory_sha256"], simulated.json()["trajectory_sha256"]);
}

TEST(Run, EndsInOrderOnCtrlC) {
  ScratchFolder folder;
  Command command(run_line({"--speed", "0.2", "--out", folder.file("kept")}));
  ASSERT_TRUE(eventually([&] { return command.children().size() == 3; }));
  ASSERT_TRUE(heard("COMMAND", 20));
  const auto children = command.children();
  command.signal(SIGINT);
  EXPECT_EQ(command.wait(), 130) << command.err();
  EXPECT_EQ(command.json()["verdict"], "interrupted");
  EXPECT_GT(command.json()["interrupted_at"], 0.0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("kept/trajectory.csv")));
  for (const int pid : children) EXPECT_NE(kill(pid, 0), 0) << "left behind";
}

TEST(Run, NamesAProcessThatIsKilledAndLeavesNoneBehind) {
  for (std::size_t victim = 0; victim < 3; ++victim) {
    SCOPED_TRACE(victim);
    Command command(run_line({"--speed", "0.2"}));
    ASSERT_TRUE(eventually([&] { return command.children().size() == 3; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    const auto children = command.children();
    kill(children[victim], SIGKILL);
    EXPECT_EQ(command.wait(), 3);
    const char* names[] = {"mixloop-planner", "mixloop-controller", "mixloop-plant"};
    EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), HasSubstr(names[victim]));
    for (const int pid : children) EXPECT_NE(kill(pid, 0), 0) << "left behind";
  }
}

TEST(Run, LeavesNoProcessBehindWhenItIsKilledItself) {
  Command command(run_line({"--speed", "0.2"}));
  ASSERT_TRUE(eventually([&] { return command.children().size() == 3; }));
  const auto children = command.children();
  command.signal(SIGKILL);
  command.wait();
  for (const int pid : children) EXPECT_TRUE(eventually([&] { return kill(pid, 0) != 0; })) << "left behind";
}

TEST(Run, SaysThatAPeerIsLost) {
  Command command(run_line({"--without", "controller", "--patience", "0.3", "--speed", "0.2"}));
  std::optional<Command> stranger;
  stranger.emplace(std::vector<std::string>{bin("mixloop-controller"), experiment("paper")});
  ASSERT_TRUE(heard("COMMAND", 20));
  stranger->signal(SIGKILL);
  EXPECT_EQ(command.wait(), 3);
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), HasSubstr("MIXLOOP_COMMAND"));
}

TEST(Run, SaysAtOnceWhatItWaitsForAndHowThatIsStarted) {
  Command command({bin("mixloop"), "run", experiment("paper"), "--without", "controller", "--set",
                   "parameters.payload=4 kg", "--set", "expect={}", "--channel-prefix", "OURS_"});
  ASSERT_TRUE(eventually([&] { return command.err().find("mixloop-controller") != std::string::npos; }))
      << command.err();
  const std::string said = command.err();
  EXPECT_THAT(said, HasSubstr("waiting up to 60 s for a controller, to be heard on OURS_COMMAND"));
  const std::string line = said.substr(said.find("  " + bin("mixloop-controller")) + 2);
  Command ours({"/bin/sh", "-c", line.substr(0, line.find('\n'))});
  EXPECT_EQ(command.wait(), 0) << command.err();
  EXPECT_THAT(command.err(), HasSubstr("all are there"));
  EXPECT_EQ(ours.wait(), 0) << ours.err();
}

TEST(Run, WaitsAsLongAsItIsTold) {
  Command command(
      {bin("mixloop"), "run", experiment("paper"), "--without", "planner", "--first-wait", "0.5"});
  EXPECT_EQ(command.wait(std::chrono::seconds(20)), 3);
  EXPECT_THAT(command.err(), HasSubstr("waiting up to 0.5 s for a planner"));
  EXPECT_THAT(command.err(), HasSubstr("MIXLOOP_REFERENCE is silent too"));
}

TEST(Run, TakesAStrangersPlant) {
  Command command({bin("mixloop"), "run", experiment("paper"), "--without", "plant", "--json"});
  ASSERT_TRUE(eventually([] { return listeners() >= 3; })) << command.err();
  Command plant({bin("mixloop-plant"), experiment("paper"), "--json"});
  EXPECT_EQ(plant.wait(), 0) << plant.err();
  EXPECT_EQ(plant.json()["trajectory_sha256"], simulated_hash());
  // What was heard of it is judged: all of it.
  EXPECT_EQ(command.wait(), 0) << command.err();
  EXPECT_EQ(command.json()["trajectory_sha256"], simulated_hash());
  EXPECT_EQ(command.json()["max_position_error"], plant.json()["max_position_error"]);
  EXPECT_EQ(command.json()["session"], plant.json()["session"]);
}

TEST(Run, SaysWhatItMeasuredOfAStrangersPlantThatIsStopped) {
  Command command({bin("mixloop"), "run", experiment("paper"), "--without", "plant"});
  ASSERT_TRUE(eventually([] { return listeners() >= 3; })) << command.err();
  Command plant({bin("mixloop-plant"), experiment("paper"), "--json", "--speed", "0.5"});
  ASSERT_TRUE(heard("STATE", 100));
  plant.signal(SIGINT);
  EXPECT_EQ(plant.wait(), 130) << plant.err();
  EXPECT_EQ(command.wait(), 130) << command.out() << command.err();
  EXPECT_THAT(command.out(), HasSubstr("ticks are missing: the rest was heard and measured"));
}

TEST(Run, SaysThatThereWasNoStrangersPlant) {
  Command command({bin("mixloop"), "run", experiment("paper"), "--without", "plant", "--first-wait", "0.3"});
  EXPECT_EQ(command.wait(), 3);
  EXPECT_THAT(command.err(), HasSubstr("the plant is missing"));
}

TEST(Run, NamesTheAnswersThatItsPlantCouldNotTake) {
  Command command(
      {bin("mixloop"), "run", experiment("paper"), "--json", "--without", "controller", "--first-wait", "2"});
  Command other({bin("mixloop-controller"), experiment("paper"), "--set", "parameters.payload=4 kg"});
  EXPECT_EQ(other.wait(), 3);
  EXPECT_THAT(
      other.err(),
      HasSubstr("another shared parameters than this process: shared parameters is payload = 4 here"));
  EXPECT_EQ(command.wait(), 3);
}

TEST(Run, GoesOnHoldingUntilItIsStopped) {
  Command command({bin("mixloop"), "run", experiment("paper"), "--hold", "--speed", "5"});
  ASSERT_TRUE(eventually([&] { return command.out().find("Holding the end point") != std::string::npos; }))
      << command.out() << command.err();
  EXPECT_THAT(command.out(), HasSubstr("13.2066936 mm"));
  EXPECT_THAT(command.out(), HasSubstr("nsenter"));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_TRUE(command.running());
  command.signal(SIGINT);
  EXPECT_EQ(command.wait(), 0) << command.err();
}

}  // namespace
}  // namespace mixloop
