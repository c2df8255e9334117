// SPDX-License-Identifier: MIT
// The controllers of examples/ against our plant and planner: a PD law, so the bytes of law `pd`.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

void gives_the_bytes_of_pd(const std::vector<std::string>& stranger,
                           const std::vector<std::string>& environment = {}) {
  const std::vector<std::string> sets = {"--set", "controller.law=pd", "--set", "expect={}", "--json"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), sets.begin(), sets.end());
    return words;
  };
  Command simulate(with({bin("mixloop"), "simulate", experiment("paper")}));
  Command run(with({bin("mixloop"), "run", experiment("paper"), "--without", "controller"}));
  Command controller(stranger, environment);
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  ASSERT_EQ(run.wait(), 0) << run.err() << controller.err();
  EXPECT_EQ(controller.wait(), 0) << controller.err();
  EXPECT_EQ(run.json()["trajectory_sha256"], simulate.json()["trajectory_sha256"]);
}

TEST(Examples, ControllerInCpp) { gives_the_bytes_of_pd({bin("example_controller")}); }

TEST(Examples, ControllerInPython) {
  if (!std::filesystem::exists("/usr/bin/python3")) GTEST_SKIP() << "no python3";
  gives_the_bytes_of_pd({"/usr/bin/python3", MIXLOOP_SOURCE "/examples/controller.py"},
                        {"PYTHONPATH=" MIXLOOP_TYPES_PYTHON, "PYTHONDONTWRITEBYTECODE=1"});
}

TEST(Examples, ControllerInJava) {
  const std::string classes = MIXLOOP_JAVA_CLASSES;
  if (classes.empty()) GTEST_SKIP() << "no JDK or no liblcm-java";
  gives_the_bytes_of_pd({"/usr/bin/java", "-Djava.net.preferIPv4Stack=true", "-cp", classes, "Controller"});
}

}  // namespace
}  // namespace mixloop
