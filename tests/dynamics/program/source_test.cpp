// SPDX-License-Identifier: MIT
#include "dynamics/program/source.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/program/firmware.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"
#include "tests/support/command.hpp"

namespace mixloop {
namespace {

namespace fs = std::filesystem;

// A user's compiler, with all warnings as errors.
bool builds(const std::string& source, const std::string& compiler, const std::string& flags) {
  const ScratchFolder folder;
  const std::string file = folder.write("emitted.cpp", source);
  const std::string command = compiler + " -Wall -Wextra -Wpedantic -Werror " + flags + " -c " + file +
                              " -o " + folder.file("emitted.o");
  return std::system(command.c_str()) == 0;
}

TEST(Source, BuildsWithoutAWarningAsCxx17) {
  for (const char* name : {"mixed_loop_robot", "spatial_slider_crank"}) {
    const auto scene =
        std::make_shared<const Scene>(load_scene(fs::path(MIXLOOP_SCENES) / (std::string(name) + ".yaml")));
    for (Trigonometry trigonometry : {Trigonometry::inlined, Trigonometry::c_library}) {
      const std::string source = firmware_source(scene, {kPurposes.begin(), kPurposes.end()}, trigonometry);
      EXPECT_TRUE(builds(source, "g++", "-std=c++17 -O1")) << name;
      if (std::system("clang++ --version > /dev/null 2>&1") == 0) {
        EXPECT_TRUE(builds(source, "clang++", "-std=c++17 -O1")) << name;
      }
    }
  }
}

// Long programs are written in parts.
TEST(Source, ALongProgramBuildsWithoutAWarning) {
  const auto chain =
      std::make_shared<const Scene>(load_scene(parse_document(oracle::serial_chain(8), "chain")));
  const std::string source = firmware_source(chain, {Purpose::forward_dynamics}, Trigonometry::inlined);
  ASSERT_NE(source.find("_part_1"), std::string::npos);
  EXPECT_TRUE(builds(source, "g++", "-std=c++17 -O1"));
}

// A scene is data: none of its words may become code, not even in a comment.
TEST(Source, HoldsNoTextOfTheScene) {
  Scene scene = load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml");
  scene.name = "*/ int evil() { return 1; } /*";
  for (auto& coordinate : scene.independent) coordinate.name = "evil";
  for (auto& coordinate : scene.coordinates) coordinate.name = "evil";
  for (auto& parameter : scene.parameters) parameter.name = "evil";
  for (auto& body : scene.bodies) body.name = "evil";
  for (auto& frame : scene.frames) frame = "evil";
  const std::string source = firmware_source(std::make_shared<const Scene>(scene),
                                             {Purpose::forward_dynamics}, Trigonometry::inlined);
  EXPECT_EQ(source.find("evil"), std::string::npos);
}

TEST(Source, IsTheSameForTheSameScene) {
  const auto scene = std::make_shared<const Scene>(load_scene(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  const std::vector<Purpose> purposes{Purpose::forward_dynamics, Purpose::mass_times};
  EXPECT_EQ(firmware_source(scene, purposes, Trigonometry::inlined),
            firmware_source(scene, purposes, Trigonometry::inlined));
}

}  // namespace
}  // namespace mixloop
