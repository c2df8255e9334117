// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "certification.hpp"
#include "dynamics/evaluator.hpp"
#include "dynamics/program/cache.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/trace.hpp"
#include "dynamics/scene/load_scene.hpp"
#include "tests/support/allocation_counter.hpp"

namespace mixloop::testing {
namespace {

namespace fs = std::filesystem;

std::shared_ptr<const Scene> scene_named(const std::string& name) {
  return std::make_shared<const Scene>(load_scene(fs::path(MIXLOOP_SCENES) / (name + ".yaml")));
}

/// A cache of the test's own, empty.
class MachineCodeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "mixloop-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
    ::setenv("MIXLOOP_CACHE", (directory_ / "cache").c_str(), 1);
    ::unsetenv("MIXLOOP_CXX");
  }
  void TearDown() override {
    ::unsetenv("MIXLOOP_CXX");
    fs::remove_all(directory_);
  }

  fs::path cache() const { return directory_ / "cache"; }
  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(cache())) found.push_back(entry.path());
    return found;
  }
  std::unique_ptr<MachineCode> load(int* traced = nullptr) const {
    std::string complaint;
    auto code = MachineCode::load("key", [&] {
      if (traced != nullptr) ++*traced;
      return trace(robot_, Purpose::mass_matrix).program;
    }, complaint);
    EXPECT_TRUE(code) << complaint;
    return code;
  }

  fs::path directory_;
  std::shared_ptr<const Scene> robot_ = scene_named("mixed_loop_robot");
};

TEST_F(MachineCodeTest, GivesTheInterpretersBits) {
  for (const char* name : {"mixed_loop_robot", "spatial_slider_crank"}) {
    const auto scene = scene_named(name);
    const std::vector<double> parameters = scene->default_parameters();
    for (Purpose purpose : {Purpose::forward_dynamics, Purpose::mass_times, Purpose::end_effector, Purpose::energy}) {
      const Program program = trace(scene, purpose).program;
      std::string complaint;
      auto code = MachineCode::load(std::string(name) + std::string(name_of(purpose)), [&] { return program; }, complaint);
      ASSERT_TRUE(code) << complaint;
      Interpreter interpreter(program);
      code->set_up(parameters);
      interpreter.set_up(parameters);
      std::mt19937_64 random(3);
      std::vector<double> compiled(program.outputs.size()), interpreted(program.outputs.size());
      for (int k = 0; k < 200; ++k) {
        const Sample sample = random_sample(*scene, random, k % 10 == 0 ? 1e8 : 30.0);  // also beyond the fast range
        code->evaluate(sample.arguments(), compiled.data());
        interpreter.evaluate(sample.arguments(), interpreted.data());
        ASSERT_EQ(compiled, interpreted) << name << ", " << name_of(purpose) << ", state " << k;
      }
    }
  }
}

TEST_F(MachineCodeTest, IsBuiltOnceAndThenFound) {
  int traced = 0;
  load(&traced);
  load(&traced);
  EXPECT_EQ(traced, 1);
  EXPECT_EQ(entries().size(), 1u);
  struct stat info {};
  ASSERT_EQ(::stat(cache().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700u);
}

TEST_F(MachineCodeTest, RebuildsADamagedEntryWithoutLoadingIt) {
  load();
  const fs::path entry = entries().at(0);
  {
    std::fstream file(entry, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file << "damage";
  }
  int traced = 0;
  load(&traced);
  EXPECT_EQ(traced, 1);
  fs::resize_file(entry, 10);
  load(&traced);
  EXPECT_EQ(traced, 2);
}

TEST_F(MachineCodeTest, RebuildsAnEntryMadeForAnotherKey) {
  load();
  const fs::path entry = entries().at(0);
  const fs::path copy = directory_ / "other.so";
  fs::copy_file(entry, copy);
  EXPECT_TRUE(CacheEntry(cache(), entry.stem().string()).is_sound());
  fs::copy_file(copy, cache() / "0123.so");
  EXPECT_FALSE(CacheEntry(cache(), "0123").is_sound());
}

TEST_F(MachineCodeTest, TakesNoEntryThatOthersMayWriteAndFollowsNoLink) {
  load();
  const fs::path entry = entries().at(0);
  const CacheEntry kept(cache(), entry.stem().string());
  ASSERT_EQ(::chmod(entry.c_str(), 0722), 0);
  EXPECT_FALSE(kept.is_sound());
  ASSERT_EQ(::chmod(entry.c_str(), 0700), 0);
  EXPECT_TRUE(kept.is_sound());
  fs::rename(entry, directory_ / "moved.so");
  fs::create_symlink(directory_ / "moved.so", entry);
  EXPECT_FALSE(kept.is_sound());
}

TEST_F(MachineCodeTest, UsesNoDirectoryThatOthersMayWrite) {
  fs::create_directory(cache());
  ASSERT_EQ(::chmod(cache().c_str(), 0777), 0);
  EXPECT_FALSE(cache_directory());
}

TEST_F(MachineCodeTest, TwoMayBuildAtOnce) {
  std::vector<std::thread> builders;
  for (int k = 0; k < 4; ++k) builders.emplace_back([&] { load(); });
  for (auto& builder : builders) builder.join();
  EXPECT_EQ(entries().size(), 1u);
}

TEST_F(MachineCodeTest, TheInterpreterServesWithoutACompiler) {
  ::setenv("MIXLOOP_CXX", "", 1);
  Dynamics dynamics(robot_, robot_->default_parameters(), Evaluation::machine_code, {Purpose::forward_dynamics});
  EXPECT_EQ(dynamics.evaluation(), Evaluation::interpreter);
}

TEST_F(MachineCodeTest, AnEvaluationDoesNotAllocate) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  for (Evaluation how : {Evaluation::reference, Evaluation::interpreter, Evaluation::machine_code}) {
    Dynamics dynamics(robot_, robot_->default_parameters(), how, {Purpose::forward_dynamics, Purpose::mass_times});
    const std::array psi{1.0, 2.0, 3.0}, psid{0.1, 0.2, 0.3}, tau{0.5, 0.25, 0.125};
    std::array<double, 3> out{};
    AllocationCounter counter;
    dynamics.forward_dynamics(psi, psid, tau, 0.0, out);
    dynamics.mass_times(psi, tau, 0.0, out);
    EXPECT_EQ(counter.count(), 0u) << name_of(how);
  }
}

TEST_F(MachineCodeTest, AParameterChangesWithoutANewProgram) {
  Dynamics dynamics(robot_, std::vector{5.0}, Evaluation::machine_code, {Purpose::forward_dynamics});
  Dynamics reference(robot_, std::vector{2.0}, Evaluation::reference, {Purpose::forward_dynamics});
  dynamics.set_parameters(std::vector{2.0});
  const std::array psi{1.0, 2.0, 3.0}, psid{0.1, 0.2, 0.3}, tau{0.5, 0.25, 0.125};
  std::array<double, 3> out{}, expected{};
  dynamics.forward_dynamics(psi, psid, tau, 0.0, out);
  reference.forward_dynamics(psi, psid, tau, 0.0, expected);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(out[k], expected[k], 1e-11 * std::abs(expected[1]));
}

}  // namespace
}  // namespace mixloop::testing
