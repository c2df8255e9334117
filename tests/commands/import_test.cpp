// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

std::string urdf(const std::string& name) { return MIXLOOP_SOURCE "/tests/import/robots/" + name + ".urdf"; }

class ImportCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!MIXLOOP_HAS_URDF) GTEST_SKIP() << "built without urdfdom";
  }
  const ScratchFolder folder_;
};

TEST_F(ImportCommand, WhatItWritesIsExplainedEvaluatedAndSimulatedAtOnce) {
  Command import({bin("mixloop"), "import", urdf("scara"), "--out", folder_.file("new/robots")});
  ASSERT_EQ(import.wait(), 0) << import.err();
  EXPECT_THAT(import.out(), HasSubstr("motors        J1, J2, J3, J4\n"));
  EXPECT_THAT(import.err(),
              HasSubstr("scara.urdf:5:5: not carried over: inertias of links that stand still: base\n"));
  const std::string scene = folder_.file("new/robots/scara.scene.yaml");
  Command explain({bin("mixloop"), "explain", scene});
  EXPECT_EQ(explain.wait(), 0) << explain.err();
  Command dynamics({bin("mixloop"), "dynamics", scene, "--psi", "0,0,0,0", "--json"});
  ASSERT_EQ(dynamics.wait(), 0) << dynamics.err();
  Command simulate({bin("mixloop"), "simulate", folder_.file("new/robots/scara.experiment.yaml")});
  EXPECT_EQ(simulate.wait(), 0) << simulate.out() << simulate.err();
}

TEST_F(ImportCommand, FilesThatAreThereStayUnlessForced) {
  const std::vector<std::string> words = {"import", urdf("cart_pole"), "--out", folder_.path(), "--name",
                                          "mine",   "--free",          "pole"};
  std::vector<std::string> line = words;
  line.insert(line.begin(), bin("mixloop"));
  ASSERT_EQ(Command(line).wait(), 0);
  folder_.write("mine.scene.yaml", "mine");
  expect_refused(words, 2, "file_exists", "--force");
  EXPECT_EQ(bytes_of(folder_.file("mine.scene.yaml")), "mine");
  line.emplace_back("--force");
  ASSERT_EQ(Command(line).wait(), 0);
  EXPECT_THAT(bytes_of(folder_.file("mine.scene.yaml")), HasSubstr("free: [pole]\n"));
}

TEST_F(ImportCommand, JsonSaysWhatBecameOfIt) {
  Command command({bin("mixloop"), "import", urdf("gripper"), "--out", folder_.path(), "--json"});
  ASSERT_EQ(command.wait(), 0) << command.err();
  const auto json = command.json();
  EXPECT_EQ(json["motors"], nlohmann::json({"left_knuckle_joint"}));
  EXPECT_EQ(json["following"].size(), 4U);
  EXPECT_EQ(json["renamed"][0]["from"], "left-knuckle joint");
  EXPECT_EQ(json["not_carried_over"][0]["names"], nlohmann::json({"palm"}));
  EXPECT_EQ(command.err(), "");
}

TEST_F(ImportCommand, WhatIsNoRobotIsRefusedAndNothingIsWritten) {
  const std::string file = folder_.write("half.urdf", bytes_of(urdf("ur5")).substr(0, 1000));
  expect_refused({"import", file, "--out", folder_.file("out")}, 2, "invalid_xml", "expected XML");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out")));
  expect_refused({"import", folder_.file("none.urdf"), "--out", folder_.file("out")}, 2, "no_such_file",
                 "no such file");
  expect_refused({"import", urdf("ur5"), "--out", file}, 3, "cannot_write", "can't be made");
}

}  // namespace
}  // namespace mixloop
