// SPDX-License-Identifier: MIT
// Sensors, drives and faults: the same bytes in one process and over the bus.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/support/bad_network.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

const std::string kSensors =
    "plant.sensors={resolution: 1e-4, noise: 2e-5, bias: 1e-3, delay: [0, 1 ms, 0], drop: 0.01}";
const std::string kActuators =
    "plant.actuators={rate_limit: 2000, time_constant: 50 us, ripple: {amplitude: 0.02, per_turn: 12}, "
    "friction: {viscous: 0.001, coulomb: 0.01}}";
const std::string kFaults =
    "faults=[{at: 0.1 s, for: 20 ms, motor: 1, kind: garbage, magnitude: 0.5}, "
    "{at: 0.2 s, for: 20 ms, sensor: 2, kind: intermittent, magnitude: 0.01}, "
    "{at: 0.3 s, for: 20 ms, motor: 3, kind: delayed, magnitude: 2 ms}, "
    "{at: 0.4 s, parameter: payload, value: 4 kg}, {at: 0.5 s, friction: 3}]";

std::vector<std::string> line(const char* what, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {bin("mixloop"), what,       experiment("paper"),
                                    "--json",       "--set",    "controller.kv=[0.5, 0.25, 0.25]",
                                    "--set",        "expect={}"};
  for (const std::string& set : {kSensors, kActuators, kFaults}) words.insert(words.end(), {"--set", set});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

nlohmann::json result(const std::vector<std::string>& words,
                      const std::vector<std::string>& environment = {}) {
  Command command(words, environment);
  EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
  return command.json();
}

TEST(Hardware, GivesTheSimulatedBytesOverTheBus) {
  const auto alone = result(line("simulate"));
  EXPECT_EQ(alone["seed"], 1);
  EXPECT_EQ(alone["ticks"], 1000);
  for (const auto& environment : {std::vector<std::string>(), bad_network(3)}) {
    SCOPED_TRACE(environment.empty() ? "a good network" : "a bad network");
    const auto bus = result(line("run"), environment);
    EXPECT_EQ(bus["trajectory_sha256"], alone["trajectory_sha256"]);
    EXPECT_EQ(bus["seed"], 1);
  }
}

TEST(Hardware, DrawsOtherNumbersFromAnotherSeedAlone) {
  const auto one = result(line("simulate")), again = result(line("simulate", {"--set", "seed=1"})),
             other = result(line("simulate", {"--set", "seed=2"}));
  EXPECT_EQ(one["trajectory_sha256"], again["trajectory_sha256"]);
  EXPECT_NE(one["trajectory_sha256"], other["trajectory_sha256"]);
  EXPECT_EQ(other["seed"], 2);
}

TEST(Hardware, ThatIsIdealDrawsNothing) {
  const auto plain = result({bin("mixloop"), "simulate", experiment("paper"), "--json"});
  const auto seeded = result({bin("mixloop"), "simulate", experiment("paper"), "--json", "--set", "seed=5"});
  EXPECT_FALSE(plain.contains("seed") || seeded.contains("seed"));
  EXPECT_EQ(plain["trajectory_sha256"], seeded["trajectory_sha256"]);
}

TEST(Hardware, IsLeftOutOfStabilityWhichSaysSo) {
  const std::vector<std::string> words = {bin("mixloop"),
                                          "stability",
                                          experiment("paper"),
                                          "--no-confirmation",
                                          "--poses",
                                          "2",
                                          "--vary",
                                          "plant.command_delay=0 s",
                                          "--set",
                                          kActuators};
  Command told(words);
  EXPECT_EQ(told.wait(), 0) << told.out();
  const std::string said = told.err();
  EXPECT_THAT(said, HasSubstr("ideal hardware"));
  EXPECT_EQ(said.find("ideal hardware"), said.rfind("ideal hardware")) << "once";
}

// A plant whose payload falls at 0.5 s: what trajectory.csv says of energy and acceleration is of the lighter
// robot.
TEST(Hardware, KeepsAccountsOfAPayloadThatFalls) {
  const ScratchFolder folder;
  result({bin("mixloop"), "simulate", experiment("paper"), "--json", "--set", "expect={}", "--set",
          "faults=[{at: 0.5 s, parameter: payload, value: 0 kg}]", "--out", folder.file("fallen")});
  std::ifstream file(folder.file("fallen/trajectory.csv"));
  std::string text;
  std::getline(file, text);
  std::vector<std::string> names;
  for (std::istringstream in(text); std::getline(in, text, ',');) names.push_back(text);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::size_t t = column("t"), kinetic = column("kinetic_energy"),
                    potential = column("potential_energy"), work = column("work"),
                    height = column("position_z_actual");
  double before = 0, after = 0, fallen = 0;
  double end = 0;
  while (std::getline(file, text)) {
    std::vector<double> row;
    std::string cell;
    for (std::istringstream in(text); std::getline(in, cell, ',');) row.push_back(std::stod(cell));
    const double balance = row[kinetic] + row[potential] - row[work];
    if (row[t] < 0.4995) before = balance;
    if (row[t] > 0.4995 && row[t] < 0.5005) after = balance, fallen = row[height];
    end = balance;
  }
  // RK4 at 1 ms keeps the balance to 1e-6 J on this path (tests/stress).
  EXPECT_NEAR(end, after, 1e-5);
  // What is gone is 1/2 m v^2 + m g z of 5 kg at the height of the hand, at some 0.9 m/s.
  EXPECT_GT(before - after, 5 * 9.81 * fallen);
  EXPECT_LT(before - after, 5 * 9.81 * fallen + 0.5 * 5 * 2.0 * 2.0);
}

}  // namespace
}  // namespace mixloop
