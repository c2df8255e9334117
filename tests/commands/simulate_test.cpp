// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

nlohmann::json simulated(const std::string& name, const std::vector<std::string>& sets, int status = 0) {
  std::vector<std::string> words = {bin("mixloop"), "simulate", experiment(name), "--json"};
  for (const auto& set : sets) words.insert(words.end(), {"--set", set});
  Command command(words);
  EXPECT_EQ(command.wait(), status) << command.out() << command.err();
  return command.json();
}

// DESIGN's figures, on which three independent derivations agree to the digits shown; half a unit in the
// last.
TEST(Simulate, GivesThePapersExperimentWithContinuousControl) {
  const auto result = simulated("paper_continuous", {});
  EXPECT_NEAR(result["max_position_error"], 13.1788518e-3, 0.5e-10);
  EXPECT_EQ(result["time_of_max_position_error"], 0.486);
  EXPECT_NEAR(result["final_position_error"], 11.46972e-3, 0.5e-8);
  EXPECT_EQ(result["ticks"], 1000);
}

TEST(Simulate, SaysHowItWasEvaluatedWhateverWasAskedFor) {
  Command command({bin("mixloop"), "simulate", experiment("paper"), "--json"}, {"MIXLOOP_CXX="});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_EQ(command.json()["evaluation"], "interpreter");
  EXPECT_EQ(simulated("paper", {})["evaluation"], "machine_code");
}

TEST(Simulate, GivesThePapersExperimentWithTorqueHeld) {
  const auto result = simulated("paper", {});
  EXPECT_NEAR(result["max_position_error"], 13.2066936e-3, 0.5e-10);
  EXPECT_EQ(result["time_of_max_position_error"], 0.487);
  EXPECT_NEAR(result["final_position_error"], 11.4529188e-3, 0.5e-10);
  EXPECT_NEAR(result["max_torque"][0], 1.87281, 0.5e-5);
  EXPECT_NEAR(result["max_torque"][1], 4.70091, 0.5e-5);
  EXPECT_NEAR(result["max_torque"][2], 2.48431, 0.5e-5);
}

TEST(Simulate, GivesTheVariantsOfThePapersExperiment) {
  struct Row {
    const char* set;
    double millimetres, digit;
  };
  for (const auto& [set, millimetres, digit] :
       {Row{"plant.substeps=10", 13.1788524, 1e-7}, Row{"controller.feedforward_at=desired", 12.8586, 1e-4},
        Row{"scene.gravity=[0, 0, 0]", 14.0324, 1e-4}, Row{"parameters.payload=0 kg", 1.1123, 1e-4},
        Row{"controller.law=pd", 15.8763, 1e-4},
        Row{"controller.parameters={payload: 0 kg}", 15.632, 1e-3}}) {
    SCOPED_TRACE(set);
    const double error = simulated("paper_continuous", {set, "expect={}"})["max_position_error"];
    EXPECT_NEAR(error * 1e3, millimetres, digit / 2);
  }
}

TEST(Simulate, RingsPastTheLongestDelayAsTheLinearisationSays) {
  EXPECT_NEAR(simulated("paper", {"plant.command_delay=0.70 ms"})["max_torque"].get<std::vector<double>>()[2],
              10.8, 0.05);
  const auto result = simulated("paper", {"plant.command_delay=0.75 ms"}, 1);
  EXPECT_NEAR(result["max_position_error"], 45e-3, 0.5e-3);
  EXPECT_NEAR(result["max_torque"].get<std::vector<double>>()[2], 533, 0.5);
}

TEST(Simulate, ReportsDivergenceWithItsTime) {
  const auto result = simulated("paper", {"plant.command_delay=1 ms"}, 3);
  EXPECT_EQ(result["verdict"], "diverged");
  EXPECT_GT(result["diverged_at"], 0.01);
  EXPECT_LT(result["diverged_at"], 0.2);
  EXPECT_LT(result["max_position_error"], 0.1);  // the offending tick is not part of the result
}

TEST(Simulate, KeepsATrajectoryThatReadsBackToTheSameBytes) {
  ScratchFolder folder;
  Command command({bin("mixloop"), "simulate", experiment("paper"), "--json", "--out", folder.file("kept")});
  ASSERT_EQ(command.wait(), 0) << command.err();
  std::ifstream result(folder.file("kept/result.json"));
  EXPECT_EQ(nlohmann::json::parse(result), command.json());
  std::ifstream csv(folder.file("kept/trajectory.csv"));
  std::string header, line, last;
  std::getline(csv, header);
  EXPECT_THAT(header, testing::StartsWith("t,psi_1,psi_2,psi_3,psid_1,psid_2,psid_3,tau_1,tau_2,tau_3,"));
  EXPECT_THAT(header, HasSubstr("position_x_desired"));
  EXPECT_THAT(header, HasSubstr("acceleration_z_actual"));
  int lines = 0;
  while (std::getline(csv, line)) ++lines, last = line;
  EXPECT_EQ(lines, 1001);
  EXPECT_THAT(last, testing::StartsWith("1,"));
}

TEST(Simulate, GivesTheSameBytesByInterpreterAndMachineCode) {
  std::vector<std::string> hashes;
  for (const char* how : {"interpreter", "machine_code"}) {
    Command command({bin("mixloop"), "simulate", experiment("paper"), "--json", "--evaluation", how});
    ASSERT_EQ(command.wait(), 0) << command.err();
    EXPECT_EQ(command.json()["evaluation"], how);
    hashes.push_back(command.json()["trajectory_sha256"]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// The paper's loop contracts, so that what the ticks add does not grow: its measures stay within some of it.
TEST(Simulate, ChoosesTheIntegratorThatKeepsALocalError) {
  const double converged = 13.2066936e-3;
  int evaluations = 0;
  for (const char* asked : {"1e-3", "1e-6", "1e-9", "1e-13"}) {
    SCOPED_TRACE(asked);
    const auto result =
        simulated("paper", {"plant.integrator=auto", std::string("plant.local_error=") + asked, "expect={}"});
    const auto& integrator = result["integrator"];
    const double bound = std::stod(asked);
    EXPECT_EQ(integrator["chosen"]["local_error"], bound);
    EXPECT_LE(integrator["chosen"]["estimate"], bound / 2);
    EXPECT_THAT(integrator["chosen"]["why"].get<std::string>(), HasSubstr("the cheapest"));
    EXPECT_NEAR(result["max_position_error"], converged, std::max(bound, 0.6e-10));
    // What it settled on gives the same bytes when it is named.
    const auto named = simulated("paper", {"plant.integrator=" + integrator["name"].get<std::string>(),
                                           "plant.substeps=" + integrator["substeps"].dump(), "expect={}"});
    EXPECT_EQ(named["trajectory_sha256"], result["trajectory_sha256"]);
    const std::string name = integrator["name"];
    const int a_step = name == "dop853" ? 12 : name == "dormand_prince" ? 6 : name == "rk4" ? 4 : 1;
    EXPECT_GE(a_step * integrator["substeps"].get<int>(), evaluations) << "more accuracy is not cheaper";
    evaluations = a_step * integrator["substeps"].get<int>();
  }
}

TEST(Simulate, GivesThePapersExperimentByEveryMethodOfSomeOrder) {
  for (const char* name : {"rk4", "dormand_prince", "dop853", "gauss8"}) {
    SCOPED_TRACE(name);
    const std::string set = std::string("plant.integrator=") + name;
    EXPECT_NEAR(simulated("paper", {set})["max_position_error"], 13.2066936e-3, 0.5e-10);
    EXPECT_NEAR(simulated("paper_continuous", {set})["max_position_error"], 13.178852e-3, 0.5e-9);
  }
  EXPECT_NEAR(simulated("paper", {"plant.integrator=rodas4"})["max_position_error"], 13.2066936e-3, 0.5e-10);
  EXPECT_NEAR(simulated("paper", {"plant.integrator=rodas3"})["max_position_error"], 13.20669e-3, 0.5e-8);
  EXPECT_NEAR(
      simulated("paper", {"plant.integrator=dop853", "plant.local_error=1e-12"})["max_position_error"],
      13.2066936e-3, 0.5e-10);
}

// The same bytes again, in any way that is promised (docs/accuracy.md).
TEST(Simulate, GivesTheSameBytesOnARerunAndWithResultsKept) {
  for (const char* name : {"rk4", "dop853", "rodas4", "auto"}) {
    SCOPED_TRACE(name);
    const std::vector<std::string> sets = {std::string("plant.integrator=") + name,
                                           "plant.command_delay=0.3 ms"};
    const auto first = simulated("paper", sets);
    EXPECT_EQ(simulated("paper", sets)["trajectory_sha256"], first["trajectory_sha256"]);
    ScratchFolder folder;
    Command kept({bin("mixloop"), "simulate", experiment("paper"), "--json", "--set", sets[0], "--set",
                  sets[1], "--out", folder.file("kept")});
    ASSERT_EQ(kept.wait(), 0) << kept.err();
    EXPECT_EQ(kept.json()["trajectory_sha256"], first["trajectory_sha256"]);
  }
}

TEST(Simulate, KeepsThePartialResultOnCtrlC) {
  ScratchFolder folder;
  // An hour and a half of simulated time: long enough to be interrupted on any machine.
  Command command({bin("mixloop"), "simulate", experiment("there_and_back"), "--json", "--set",
                   "path.repeat=2700", "--out", folder.file("kept")});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.file("kept")); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  command.signal(SIGINT);
  ASSERT_EQ(command.wait(), 130) << command.err();
  EXPECT_EQ(command.json()["verdict"], "interrupted");
  EXPECT_TRUE(command.json().contains("interrupted_at"));
  EXPECT_TRUE(std::filesystem::exists(folder.file("kept/trajectory.csv")));
}

struct BadLine {
  std::vector<std::string> words;
  const char* code;
  const char* message;
};

TEST(Simulate, RefusesBadInputAndWritesNothing) {
  ScratchFolder folder;
  for (const auto& [words, code, message] :
       {BadLine{{experiment("nothing")}, "no_such_file", "no such file"},
        BadLine{{experiment("paper"), "--set", "plant.sbsteps=2"}, "unknown_key", "did you mean 'substeps'"},
        BadLine{{experiment("paper"), "--set", "path.duration=0.0005 s"}, "off_grid", "duration"},
        BadLine{{experiment("paper"), "--set", "controller.kp=[1, 2]"}, "wrong_size", "kp has 2 values"},
        BadLine{{experiment("paper"), "--set", "rate=5 mm"}, "wrong_dimension", "a length"},
        BadLine{{experiment("paper"), "--set", "path.line.to=[-0.3, 0.4, 3]"}, "unreachable", "reach"},
        BadLine{{experiment("paper"), "--set", "scene.bodies[0].mass=-1 kg"}, "negative_mass", "-1 kg"},
        BadLine{{experiment("paper"), "--set", "plant.integrator=rk5"},
                "unknown_value",
                "expected one of semi_implicit_euler, leapfrog, rk4, dormand_prince, dop853, gauss8, rodas3, "
                "rodas4, "
                "auto"},
        BadLine{
            {experiment("paper"), "--set", "plant.local_error=1e-9"}, "out_of_range", "rk4 has no estimate"},
        BadLine{{experiment("paper"), "--set", "plant={integrator: auto, local_error: 2}"},
                "out_of_range",
                "1e-14 to 0.1"},
        BadLine{{experiment("paper"), "--set", "plant={integrator: auto, substeps: 2}"},
                "doubly_defined",
                "finds the substeps itself"},
        BadLine{{experiment("paper"), "--set", "plant={integrator: rodas4, control: continuous}"},
                "out_of_range",
                "the controller's share"},
        BadLine{{experiment("paper"), "--set", "plant={integrator: auto, control: continuous}"},
                "out_of_range",
                "name one"},
        BadLine{{experiment("paper"), "--set",
                 "plant={integrator: dop853, local_error: 1e-9, control: continuous}"},
                "out_of_range",
                "fixed stages"},
        BadLine{{experiment("paper"), "--set", "plant={integrator: auto, local_error: 1e-14}", "--set",
                 "rate=10 Hz"},
                "out_of_reach",
                "no integrator keeps"},
        BadLine{{experiment("paper"), "--set", "path.repeat=1000000", "--set", "path.duration=100 s"},
                "too_large",
                "GB of memory"},
        BadLine{{experiment("paper"), "--evaluation", "fast"}, "command_line", "reference"},
        BadLine{{experiment("paper"), "--jsom"}, "command_line", "did you mean '--json'?"},
        BadLine{{experiment("paper"), "--set", "nonsense"}, "invalid_override", "key=value"},
        BadLine{{experiment("paper"), "--sett", "x=1"}, "command_line", "--sett"}}) {
    SCOPED_TRACE(words.back());
    std::vector<std::string> line = {bin("mixloop"), "simulate", "--json", "--out", folder.file("kept")};
    line.insert(line.end(), words.begin(), words.end());
    Command command(line);
    EXPECT_EQ(command.wait(), 2);
    const auto error = command.json().at("error");
    EXPECT_EQ(error["code"], code);
    EXPECT_THAT(error["message"].get<std::string>(), HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder.file("kept")));
  }
}

}  // namespace
}  // namespace mixloop
