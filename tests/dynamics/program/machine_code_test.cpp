// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "certification.hpp"
#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/program/cache.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/lanes.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/trace.hpp"
#include "integrators/leapfrog.hpp"
#include "integrators/rk4.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/command.hpp"

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
    ::setenv("MIXLOOP_CACHE", (directory_ / "cache").c_str(), 1);
    ::unsetenv("MIXLOOP_CXX");
  }
  void TearDown() override { ::unsetenv("MIXLOOP_CXX"); }

  fs::path cache() const { return directory_ / "cache"; }
  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(cache())) found.push_back(entry.path());
    return found;
  }
  std::unique_ptr<MachineCode> load(int* traced = nullptr) const {
    std::string complaint;
    auto code = MachineCode::load(
        "key",
        [&] {
          if (traced != nullptr) ++*traced;
          return trace(robot_, Purpose::mass_matrix).program;
        },
        complaint);
    EXPECT_TRUE(code) << complaint;
    return code;
  }

  const ScratchFolder folder_;
  const fs::path& directory_ = folder_.path();
  std::shared_ptr<const Scene> robot_ = scene_named("mixed_loop_robot");
};

TEST_F(MachineCodeTest, GivesTheInterpretersBits) {
  for (const char* name : {"mixed_loop_robot", "spatial_slider_crank"}) {
    const auto scene = scene_named(name);
    const std::vector<double> parameters = scene->default_parameters();
    for (Purpose purpose :
         {Purpose::forward_dynamics, Purpose::mass_times, Purpose::end_effector, Purpose::energy}) {
      const Program program = trace(scene, purpose).program;
      std::string complaint;
      auto code = MachineCode::load(
          std::string(name) + std::string(name_of(purpose)), [&] { return program; }, complaint);
      ASSERT_TRUE(code) << complaint;
      const Interpreter interpreter(program);
      Evaluator by_code(*code), by_interpreter(interpreter);
      by_code.set_up(parameters);
      by_interpreter.set_up(parameters);
      std::mt19937_64 random(3);
      std::vector<double> compiled(program.outputs.size()), interpreted(program.outputs.size());
      for (int k = 0; k < 200; ++k) {
        const Sample sample =
            random_sample(*scene, random, k % 10 == 0 ? 1e8 : 30.0);  // also beyond the fast range
        by_code.evaluate(sample.arguments(), compiled);
        by_interpreter.evaluate(sample.arguments(), interpreted);
        ASSERT_EQ(compiled, interpreted) << name << ", " << name_of(purpose) << ", state " << k;
      }
    }
  }
}

/// x = psi, psi' and the motors' work after three steps of a method on evaluations.
template <class Stepper>
Vector stepped(Stepper method, Equations::Workspace dynamics, Vector x, std::span<const double> tau, double t,
               double h) {
  const auto n = static_cast<std::size_t>(dynamics.scene().n());
  method.begin();
  for (int step = 0; step < 3; ++step)
    method.step(x, h, [&](int, double c, const Vector& at, Vector& dx) {
      const std::span<const double> state = span_of(at);
      dx.head(x.size() / 2) = at.segment(x.size() / 2, x.size() / 2);
      dynamics.evaluate(Purpose::forward_dynamics,
                        {state.first(n), state.subspan(n, n), tau, t + (step + c) * h},
                        span_of(dx).subspan(n, n));
      dx[x.size() - 1] = map_of(tau).dot(at.segment(x.size() / 2, std::ssize(tau)));
    });
  return x;
}

// With motors and without, and of a formula in time.
TEST_F(MachineCodeTest, WholeStepsGiveTheBitsOfTheirEvaluations) {
  for (const char* name : {"mixed_loop_robot", "spatial_slider_crank", "cart_pole", "kapitza_pendulum"}) {
    const auto scene = scene_named(name);
    const std::vector<double> parameters = scene->default_parameters();
    const auto of = [&](Evaluation how) {
      return Equations::Workspace(equations_of(scene, how, {Purpose::forward_dynamics}), parameters);
    };
    Equations::Workspace compiled = of(Evaluation::machine_code);
    const Equations::Workspace interpreted = of(Evaluation::interpreter);
    ASSERT_FALSE(interpreted.has_steps(StepsBy::rk4)) << name;
    std::mt19937_64 random(9);
    for (int k = 0; k < 100; ++k) {
      const Sample sample = random_sample(*scene, random, 30.0);
      const Eigen::Index n = scene->n(), size = 2 * n + 1;
      Vector start(size);
      start << map_of(std::span<const double>(sample.psi)), map_of(std::span<const double>(sample.psid)), 0.5;
      const auto tau = std::span<const double>(sample.input).first(static_cast<std::size_t>(scene->n_u()));
      for (StepsBy method : kStepsBy) {
        ASSERT_TRUE(compiled.has_steps(method)) << name;
        Vector x = start;
        compiled.go_on(method, span_of(x), tau, sample.t, 1e-3, 3);
        const Vector expected =
            method == StepsBy::rk4
                ? stepped(Rk4<double>(n, size), interpreted, start, tau, sample.t, 1e-3)
                : stepped(Leapfrog<double>(n, size), interpreted, start, tau, sample.t, 1e-3);
        ASSERT_EQ(x, expected) << name << ", " << name_of(method) << ", state " << k;
      }
    }
  }
}

// The sum that is the work of more than three motors has another order; closures are solved from a start.
TEST_F(MachineCodeTest, ManyMotorsAndClosuresHaveNoWholeSteps) {
  for (const char* name : {"puma_560", "slider_crank_closed"}) {
    const auto scene = scene_named(name);
    const Equations::Workspace dynamics(
        equations_of(scene, Evaluation::machine_code, {Purpose::forward_dynamics}),
        scene->default_parameters());
    EXPECT_FALSE(dynamics.has_steps(StepsBy::rk4)) << name;
  }
}

TEST_F(MachineCodeTest, EachLaneGivesTheBitsOfItsStateAlone) {
  for (const char* name : {"mixed_loop_robot", "spatial_slider_crank"}) {
    const auto scene = scene_named(name);
    const std::vector<double> parameters = scene->default_parameters();
    const Program program = trace(scene, Purpose::forward_dynamics).program;
    std::string complaint;
    const auto lanes = LaneCode::load(
        name, [&] { return program; }, complaint);
    ASSERT_TRUE(lanes) << complaint;
    const std::vector<double> constants = lanes->constants(parameters);
    const Interpreter interpreter(program);
    Evaluator evaluator(interpreter);
    evaluator.set_up(parameters);
    const auto width = static_cast<std::size_t>(lanes->width()), n = static_cast<std::size_t>(scene->n());
    std::mt19937_64 random(5);
    for (int round = 0; round < 20; ++round) {
      std::vector<double> psi(n * width), psid(psi), tau(psi), out(psi), t(width), alone(n);
      std::vector<Sample> samples;
      for (std::size_t lane = 0; lane < width; ++lane) {
        const Sample& sample =
            samples.emplace_back(random_sample(*scene, random, round % 5 == 4 ? 1e8 : 30.0));
        for (std::size_t i = 0; i < n; ++i) {
          psi[i * width + lane] = sample.psi[i], psid[i * width + lane] = sample.psid[i];
          tau[i * width + lane] = sample.input[i];
        }
        t[lane] = sample.t;
      }
      lanes->run({psi, psid, tau, t}, constants, out.data());
      for (std::size_t lane = 0; lane < width; ++lane) {
        evaluator.evaluate(samples[lane].arguments(), alone);
        for (std::size_t i = 0; i < n; ++i)
          ASSERT_EQ(out[i * width + lane], alone[i]) << name << ", lane " << lane;
      }
    }
  }
}

// Long enough to be written in parts.
TEST_F(MachineCodeTest, PartsOfALongProgramGiveTheInterpretersBits) {
  const auto chain =
      std::make_shared<const Scene>(load_scene(parse_document(oracle::serial_chain(8), "chain")));
  Equations::Workspace compiled(equations_of(chain, Evaluation::machine_code, {Purpose::forward_dynamics}),
                                {});
  Equations::Workspace interpreted(equations_of(chain, Evaluation::interpreter, {Purpose::forward_dynamics}),
                                   {});
  ASSERT_GT(trace(chain, Purpose::forward_dynamics).program.run_operations().flops(), 2000u);
  ASSERT_EQ(compiled.equations().evaluation(), Evaluation::machine_code);
  std::mt19937_64 random(4);
  std::vector<double> one(8), other(8);
  for (int k = 0; k < 50; ++k) {
    const Sample sample = random_sample(*chain, random);
    const auto tau = std::span(sample.input).first(8);
    compiled.evaluate(Purpose::forward_dynamics, {sample.psi, sample.psid, tau}, one);
    interpreted.evaluate(Purpose::forward_dynamics, {sample.psi, sample.psid, tau}, other);
    ASSERT_EQ(one, other);
  }
}

TEST_F(MachineCodeTest, AProgramTooLongToCompileIsInterpretedAndSaysSo) {
  const auto chain =
      std::make_shared<const Scene>(load_scene(parse_document(oracle::serial_chain(64), "chain")));
  const auto equations = equations_of(chain, Evaluation::machine_code, {Purpose::forward_dynamics});
  EXPECT_EQ(equations->evaluation(), Evaluation::interpreter);
  EXPECT_EQ(equations->complaint(), "");
  EXPECT_TRUE(entries().empty());
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

// A name that is taken again must not give the library that had it before.
TEST_F(MachineCodeTest, AnotherProgramIsAnotherLibraryWhenTheFirstHasGone) {
  std::string complaint;
  for (Purpose purpose : {Purpose::mass_matrix, Purpose::bias, Purpose::mass_matrix}) {
    const auto code = MachineCode::load(
        std::string(name_of(purpose)), [&] { return trace(robot_, purpose).program; }, complaint);
    ASSERT_TRUE(code) << complaint;
    const Interpreter interpreter(trace(robot_, purpose).program);
    Evaluator by_code(*code), by_interpreter(interpreter);
    by_code.set_up(robot_->default_parameters());
    by_interpreter.set_up(robot_->default_parameters());
    std::mt19937_64 random(7);
    const Sample sample = random_sample(*robot_, random);
    std::vector<double> compiled(9), interpreted(9);
    by_code.evaluate(sample.arguments(), compiled);
    by_interpreter.evaluate(sample.arguments(), interpreted);
    EXPECT_EQ(compiled, interpreted) << name_of(purpose);
  }
}

TEST_F(MachineCodeTest, TheInterpreterServesWhereOthersMayWriteAboveTheCache) {
  ASSERT_EQ(::chmod(directory_.c_str(), 0777), 0);
  const auto equations = equations_of(robot_, Evaluation::machine_code, {Purpose::forward_dynamics});
  EXPECT_EQ(equations->evaluation(), Evaluation::interpreter);
  EXPECT_NE(equations->complaint().find("others may write to " + directory_.string()), std::string::npos);
}

TEST_F(MachineCodeTest, TwoMayBuildAtOnce) {
  std::vector<std::thread> builders;
  for (int k = 0; k < 4; ++k) builders.emplace_back([&] { load(); });
  for (auto& builder : builders) builder.join();
  EXPECT_EQ(entries().size(), 1u);
}

TEST_F(MachineCodeTest, TheInterpreterServesWithoutACompiler) {
  ::setenv("MIXLOOP_CXX", "", 1);
  const auto equations = equations_of(robot_, Evaluation::machine_code, {Purpose::forward_dynamics});
  EXPECT_EQ(equations->evaluation(), Evaluation::interpreter);
  EXPECT_EQ(equations->complaint(),
            "no C++ compiler (c++, g++, clang++, $CXX; on Debian: apt-get install g++)");
}

TEST_F(MachineCodeTest, NoEvaluationOfAnyPurposeAllocates) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has its own malloc";
  const std::array psi{1.0, 2.0, 3.0}, psid{0.1, 0.2, 0.3};
  const std::array both{0.5, 0.25, 0.125, 0.5, 0.25, 0.125};
  for (Evaluation how : {Evaluation::reference, Evaluation::interpreter, Evaluation::machine_code}) {
    for (Purpose purpose : kPurposes) {
      Equations::Workspace dynamics(equations_of(robot_, how, {purpose}), robot_->default_parameters());
      std::vector<double> out = dynamics.outputs(purpose);
      static_assert(noexcept(dynamics.evaluate(purpose, {psi, psid, both}, out)), "no exception leaves");
      AllocationCounter counter;
      EXPECT_EQ(dynamics.evaluate(purpose, {psi, psid, both}, out), Status::ok);
      EXPECT_EQ(counter.count(), 0u) << name_of(how) << ", " << name_of(purpose);
    }
  }
}

TEST_F(MachineCodeTest, AParameterChangesWithoutANewProgram) {
  Equations::Workspace dynamics(equations_of(robot_, Evaluation::machine_code, {Purpose::forward_dynamics}),
                                std::vector{5.0});
  Equations::Workspace reference(equations_of(robot_, Evaluation::reference, {Purpose::forward_dynamics}),
                                 std::vector{2.0});
  dynamics.set_parameters(std::vector{2.0});
  const std::array psi{1.0, 2.0, 3.0}, psid{0.1, 0.2, 0.3}, tau{0.5, 0.25, 0.125};
  std::array<double, 3> out{}, expected{};
  dynamics.evaluate(Purpose::forward_dynamics, {psi, psid, tau}, out);
  reference.evaluate(Purpose::forward_dynamics, {psi, psid, tau}, expected);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(out[k], expected[k], 1e-11 * std::abs(expected[1]));
}

}  // namespace
}  // namespace mixloop::testing
