// SPDX-License-Identifier: MIT
// Shipped scenes whose chains close: interpreter, machine code, lanes and the emitted C++ have the same bits,
// for all purposes, on a walk through the pose space.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "dynamics/program/firmware.hpp"
#include "dynamics/program/interpreter.hpp"
#include "dynamics/program/lanes.hpp"
#include "dynamics/program/machine_code.hpp"
#include "dynamics/program/shared_object.hpp"
#include "dynamics/program/trace.hpp"
#include "dynamics/symbolic/expression.hpp"
#include "tests/support/start_at_home.hpp"

namespace mixloop {
namespace {

constexpr auto kAllPurposes = {
    Purpose::forward_dynamics,       Purpose::mass_times,   Purpose::mass_matrix, Purpose::bias,
    Purpose::inverse_dynamics,       Purpose::end_effector, Purpose::energy,      Purpose::linearisation,
    Purpose::dynamics_and_mass_times};

struct WalkedPose {
  std::vector<double> psi, psid, input;

  Arguments arguments() const { return {psi, psid, input, 0}; }
};

struct Shipped {
  const char* name;
  double reach = 0;  ///< rad: how far its motors go to either side, where they can't turn round
};

void PrintTo(const Shipped& shipped, std::ostream* out) { *out << shipped.name; }

class ShippedClosures : public testing::TestWithParam<Shipped> {
 protected:
  void SetUp() override {
    if (const std::string why = SharedObject::hindrance(); !why.empty()) GTEST_SKIP() << why;
  }

  /// Steps from home, each with inputs for all purposes.
  std::vector<WalkedPose> walk(int count) const {
    const auto n = static_cast<std::size_t>(scene->n());
    std::vector<WalkedPose> poses;
    for (int k = 1; k <= count; ++k) {
      WalkedPose pose{scene->home, std::vector<double>(n), std::vector<double>(3 * n)};
      for (std::size_t i = 0; i < n; ++i) {
        const double along = 0.013 * k * static_cast<double>(i + 1), reach = GetParam().reach;
        pose.psi[i] += reach > 0 ? reach * std::sin(along) : along;
        pose.psid[i] = 3 * std::sin(0.7 * k + static_cast<double>(i));
      }
      for (std::size_t i = 0; i < 3 * n; ++i) pose.input[i] = 2 * std::cos(0.9 * k + static_cast<double>(i));
      poses.push_back(std::move(pose));
    }
    return poses;
  }

  /// A pose with the start behind what the purpose takes.
  WalkedPose started(Purpose purpose, WalkedPose pose, const std::vector<double>& from) const {
    pose.input.resize(static_cast<std::size_t>(signature(purpose).input_size(scene->n(), scene->n_u())));
    pose.input.insert(pose.input.end(), from.begin(), from.end());
    return pose;
  }

  std::shared_ptr<const Scene> scene =
      std::make_shared<const Scene>(load_scene(std::string(MIXLOOP_SCENES "/") + GetParam().name + ".yaml"));
  std::vector<double> parameters = scene->default_parameters();
};

TEST_P(ShippedClosures, HaveTheSameBitsAsMachineCode) {
  Equations::Workspace code(equations_of(scene, Evaluation::machine_code, kAllPurposes), parameters),
      interpreted(equations_of(scene, Evaluation::interpreter, kAllPurposes), parameters);
  ASSERT_EQ(code.equations().evaluation(), Evaluation::machine_code);
  for (const WalkedPose& pose : walk(400))
    for (Purpose purpose : kAllPurposes) {
      auto one = code.outputs(purpose), other = one;
      ASSERT_EQ(code.evaluate(purpose, pose.arguments(), one), Status::ok) << name_of(purpose);
      ASSERT_EQ(interpreted.evaluate(purpose, pose.arguments(), other), Status::ok) << name_of(purpose);
      ASSERT_EQ(one, other) << name_of(purpose) << " at " << pose.psi[0];
    }
}

TEST_P(ShippedClosures, HaveTheSameBitsInLanes) {
  for (Purpose purpose : {Purpose::forward_dynamics, Purpose::mass_times, Purpose::end_effector}) {
    const Program program = trace(scene, purpose).program;
    std::string complaint;
    const auto lanes = LaneCode::load(
        std::string("shipped ") + GetParam().name + std::string(name_of(purpose)), [&] { return program; },
        complaint);
    ASSERT_TRUE(lanes) << complaint;
    const std::vector<double> constants = lanes->constants(parameters);
    const Interpreter interpreter(program);
    Evaluator evaluator(interpreter);
    evaluator.set_up(parameters);
    const auto width = static_cast<std::size_t>(lanes->width());
    std::vector<WalkedPose> poses = walk(static_cast<int>(width));
    for (auto& pose : poses) pose = started(purpose, pose, start_at_home(*scene));
    const auto abreast = [&](std::vector<double> WalkedPose::*part) {
      std::vector<double> numbers;
      for (std::size_t i = 0; i < (poses[0].*part).size(); ++i)
        for (const auto& pose : poses) numbers.push_back((pose.*part)[i]);
      return numbers;
    };
    const std::vector<double> psi = abreast(&WalkedPose::psi), psid = abreast(&WalkedPose::psid),
                              input = abreast(&WalkedPose::input), t(width);
    const std::size_t gives = program.outputs.size();
    std::vector<double> out(gives * width), alone(gives);
    lanes->run({psi, psid, input, t}, constants, out.data());
    for (std::size_t lane = 0; lane < width; ++lane) {
      evaluator.evaluate(poses[lane].arguments(), alone);
      for (std::size_t i = 0; i < gives; ++i)
        ASSERT_EQ(out[i * width + lane], alone[i]) << name_of(purpose) << ", lane " << lane << ", " << i;
    }
  }
}

// What a user builds into firmware, the solver of what takes corrections included.
TEST_P(ShippedClosures, HaveTheSameBitsAsEmittedSource) {
  using Evaluate = void (*)(const double*, const double*, const double*, double, const double*, double*);
  using SetUpConstants = void (*)(const double*, double*);
  using Solve = int (*)(const double*, double, const double*, double*);
  std::string complaint;
  const auto library = SharedObject::cached(
      std::string("firmware of ") + scene->canonical,
      [&] { return firmware_source(scene, kAllPurposes, Trigonometry::inlined); }, complaint);
  ASSERT_TRUE(library) << complaint;
  const auto constants = [&](const std::string& prefix) {
    const int* size = static_cast<const int*>(library.symbol(prefix + "_constants"));
    EXPECT_NE(size, nullptr) << prefix;
    std::vector<double> k(static_cast<std::size_t>(*size) + 1);
    reinterpret_cast<SetUpConstants>(library.symbol(prefix + "_set_up"))(parameters.data(), k.data());
    return k;
  };
  const auto solve = reinterpret_cast<Solve>(library.symbol("mixloop_solve"));
  ASSERT_EQ(solve != nullptr, scene->corrections() > 0);
  const std::vector<double> of_closures = solve ? constants("mixloop_closures") : std::vector<double>();
  Equations::Workspace followed(equations_of(scene, Evaluation::interpreter, {Purpose::forward_dynamics}),
                                parameters);
  for (Purpose purpose : kAllPurposes) {
    const std::string prefix = "mixloop_" + std::string(name_of(purpose));
    const auto emitted = reinterpret_cast<Evaluate>(library.symbol(prefix));
    ASSERT_NE(emitted, nullptr) << prefix;
    const std::vector<double> k = constants(prefix);
    const Program program = trace(scene, purpose).program;
    const Interpreter interpreter(program);
    Evaluator evaluator(interpreter);
    evaluator.set_up(parameters);
    std::vector<double> from = start_at_home(*scene), one(program.outputs.size()), other(one),
                        psidd(static_cast<std::size_t>(scene->n()));
    for (WalkedPose pose : walk(100)) {
      if (solve) {
        ASSERT_EQ(solve(pose.psi.data(), 0, of_closures.data(), from.data()), 0);
      }
      pose = started(purpose, pose, from);
      emitted(pose.psi.data(), pose.psid.data(), pose.input.data(), 0, k.data(), one.data());
      ASSERT_EQ(evaluator.evaluate(pose.arguments(), other), Status::ok);
      ASSERT_EQ(one, other) << prefix << " at " << pose.psi[0];
      if (purpose != Purpose::forward_dynamics) continue;
      ASSERT_EQ(followed.evaluate(purpose, pose.arguments(), psidd), Status::ok);
      // Both solved to round-off, from other starts.
      EXPECT_NEAR(one[0], psidd[0], 1e-12 * std::max(1.0, std::abs(psidd[0]))) << pose.psi[0];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, ShippedClosures,
                         testing::Values(Shipped{"four_bar"}, Shipped{"slider_crank_closed"},
                                         Shipped{"double_four_bar_closed"}, Shipped{"seven_bodies"},
                                         Shipped{"planar_3rrr", 0.1}, Shipped{"delta_robot", 0.3},
                                         Shipped{"spatial_five_bar", 0.5}, Shipped{"four_bar_chain", 0.5}),
                         [](const auto& row) { return std::string(row.param.name); });

// Rotations of rotations, as closures have them: where a compiler puts two of them into a vector, GCC 12
// takes their products, sums and differences for fused ones.
TEST(Rotations, HaveTheSameBitsCompiledAndInterpreted) {
  if (const std::string why = SharedObject::hindrance(); !why.empty()) GTEST_SKIP() << why;
  Graph graph;
  Recording recording(graph);
  const auto psi = [](std::size_t i) { return Expression::input(Block::psi, i); };
  Expression x = psi(0), y = psi(1);
  std::vector<NodeId> outputs;
  for (std::size_t k = 1; k <= 8; ++k) {
    const Expression c = psi(2 * k), s = psi(2 * k + 1), turned = x * c - y * s;
    y = x * s + y * c;
    x = turned;
    outputs.insert(outputs.end(), {x.node(), y.node()});
  }
  const Program program = make_program(graph, outputs);
  std::string complaint;
  const auto code = MachineCode::load(
      "rotations of rotations", [&] { return program; }, complaint);
  ASSERT_TRUE(code) << complaint;
  const Interpreter interpreter(program);
  Evaluator compiled(*code), interpreted(interpreter);
  compiled.set_up({}), interpreted.set_up({});
  std::vector<double> at(18), one(16), other(16);
  for (int round = 0; round < 1000; ++round) {
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = std::sin(0.1 + round + 0.37 * static_cast<double>(i));
    compiled.evaluate({.psi = at}, one), interpreted.evaluate({.psi = at}, other);
    ASSERT_EQ(one, other) << round;
  }
}

// What was asked for: at most 120 and 400 operations, no sine of a solved angle.
TEST(ShippedClosure, TakesNoMoreOperationsThanAsked) {
  const auto count = [](const char* name) {
    const auto scene =
        std::make_shared<const Scene>(load_scene(std::string(MIXLOOP_SCENES "/") + name + ".yaml"));
    return trace(scene, Purpose::forward_dynamics).program.run_operations();
  };
  const auto four = count("four_bar"), seven = count("seven_bodies");
  EXPECT_LE(four.flops(), 120U);
  EXPECT_LE(seven.flops(), 400U);
  for (const auto& operations : {four, seven}) {
    EXPECT_EQ(operations.sincos, 1U);
    EXPECT_EQ(operations.other, 0U);
  }
}

// A tick in which the crank turns far is looked through in steps.
TEST(ShippedClosure, IsNotSingularBecauseItTurnsFarInATick) {
  for (const char* name : {"four_bar", "seven_bodies", "slider_crank_closed"}) {
    const auto scene =
        std::make_shared<const Scene>(load_scene(std::string(MIXLOOP_SCENES "/") + name + ".yaml"));
    Equations::Workspace watched(equations_of(scene, Evaluation::interpreter, {}), {});
    std::vector<double> psi = scene->home;
    for (int k = 0; k < 20; ++k) {
      psi[0] += 1.2;
      ASSERT_EQ(watched.closures().accept(psi, 0), Status::ok) << name;
      EXPECT_FALSE(watched.closures().watch().is_singular()) << name << " at " << psi[0];
      EXPECT_LT(watched.closures().watch().residual, 1e-14) << name;
    }
  }
}

// Crank and ground as long as coupler and rocker: stretched where the crank points away, from where two ways
// go on.
TEST(ShippedClosure, DoesNotStepOverASingularPose) {
  const NodePtr document =
      override_entry(read_document(MIXLOOP_SCENES "/four_bar.yaml"), "constants.side", "0.4 m");
  const auto scene = std::make_shared<const Scene>(load_scene(document));
  Equations::Workspace watched(equations_of(scene, Evaluation::interpreter, {}), {});
  for (const double psi : {1.5, 2.0, 2.5}) {
    ASSERT_EQ(watched.closures().accept(std::vector{psi}, 0), Status::ok);
    EXPECT_FALSE(watched.closures().watch().is_singular()) << psi;
  }
  ASSERT_EQ(watched.closures().accept(std::vector{3.8}, 0), Status::ok);
  EXPECT_TRUE(watched.closures().watch().is_singular());
}

}  // namespace
}  // namespace mixloop
