// SPDX-License-Identifier: MIT
// What is promised to stay: the bytes of each experiment's trajectory, the operations of each scene's
// programs. A change of tests/golden is a change of what users get, and stands in CHANGELOG.md.
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using Lines = std::map<std::string, std::string>;

/// The lines of a file of tests/golden: `words` of each as its key, the rest behind them.
Lines golden(const std::string& name, int words) {
  Lines lines;
  std::ifstream in(MIXLOOP_SOURCE "/tests/golden/" + name);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::size_t end = 0;
    for (int word = 0; word < words; ++word) end = line.find(' ', end + 1);
    lines[line.substr(0, end)] = line.substr(end + 1);
  }
  return lines;
}

/// The hash that a command on each experiment reports.
Lines trajectories(const Lines& experiments, const std::vector<std::string>& words) {
  Lines hashes;
  for (const auto& [name, promised] : experiments) {
    std::vector<std::string> line = {bin("mixloop"), words.front(), experiment(name), "--json"};
    line.insert(line.end(), words.begin() + 1, words.end());
    Command command(line);
    command.wait();  // some are to miss their bounds, or to diverge
    hashes[name] = command.json().at("trajectory_sha256");
  }
  return hashes;
}

TEST(Golden, EveryExperimentHasItsBytesAsMachineCode) {
  const Lines promised = golden("trajectories.txt", 1);
  ASSERT_GE(promised.size(), 16U);
  EXPECT_EQ(trajectories(promised, {"simulate"}), promised);
}

TEST(Golden, EveryExperimentHasItsBytesInterpreted) {
  const Lines promised = golden("trajectories.txt", 1);
  EXPECT_EQ(trajectories(promised, {"simulate", "--evaluation", "interpreter"}), promised);
}

TEST(Golden, TheExperimentsOverTheBusHaveTheirBytes) {
  Lines promised = golden("trajectories.txt", 1);
  promised.erase("paper_continuous");  // no bus is continuous
  EXPECT_EQ(trajectories(promised, {"run"}), promised);
}

// The first 64-bit x86 processors had no fused operations.
TEST(Golden, AnOldProcessorHasTheBytesAndSaysThatItIsSlow) {
  if (MIXLOOP_SANITIZED || std::system("qemu-x86_64 --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "nothing that stands in for an old processor (qemu-user)";
  Command command({"/usr/bin/env", "qemu-x86_64", "-cpu", "Nehalem", bin("mixloop"), "simulate",
                   experiment("four_bar_turns"), "--evaluation", "interpreter", "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  EXPECT_EQ(command.json().at("trajectory_sha256"), golden("trajectories.txt", 1).at("four_bar_turns"));
  const std::string said = command.err();
  EXPECT_NE(said.find("no fused multiply-add"), std::string::npos) << said;
  EXPECT_EQ(said.find("no fused multiply-add"), said.rfind("no fused multiply-add")) << said;
}

std::string counts(const nlohmann::json& operations) {
  std::string text;
  for (const char* kind : {"add", "mul", "div", "sqrt", "sincos", "other", "fused"})
    text += std::to_string(operations.at(kind).get<int>()) + " " + kind + " ";
  return text;
}

TEST(Golden, EverySceneHasItsPrograms) {
  const Lines promised = golden("programs.txt", 2);
  ASSERT_GE(promised.size(), 27U);
  std::set<std::string> scenes;
  for (const auto& [key, text] : promised) scenes.insert(key.substr(0, key.find(' ')));
  Lines found;
  for (const std::string& scene : scenes) {
    Command command({bin("mixloop"), "explain", MIXLOOP_SOURCE "/scenes/" + scene + ".yaml", "--json"});
    ASSERT_EQ(command.wait(), 0) << command.err();
    const nlohmann::json explained = command.json();
    for (const auto& [purpose, program] : explained.at("quantities").items()) {
      std::string text = program.at("tracing").get<std::string>() + " " + counts(program.at("pruned")) +
                         "| " + counts(program.at("set_up"));
      text.pop_back();
      found[scene + " " + purpose] = text;
    }
  }
  EXPECT_EQ(found, promised);
}

}  // namespace
}  // namespace mixloop
