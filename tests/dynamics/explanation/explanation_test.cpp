// SPDX-License-Identifier: MIT
#include "dynamics/explanation/explanation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "dynamics/assembly/load_scene.hpp"
#include "dynamics/equations.hpp"
#include "notation/document.hpp"
#include "tests/oracles/chains.hpp"

namespace mixloop {
namespace {

std::shared_ptr<const Scene> scene_of(const std::string& text) {
  return std::make_shared<const Scene>(load_scene(parse_document(text, "scene")));
}

/// The paper's robot with one piece of its text replaced.
std::shared_ptr<const Scene> robot_with(const std::string& what, const std::string& instead) {
  std::ifstream file(MIXLOOP_SCENES "/mixed_loop_robot.yaml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return scene_of(text.replace(at, what.size(), instead));
}

bool says(const std::vector<std::string>& reasons, const std::string& words) {
  return std::any_of(reasons.begin(), reasons.end(),
                     [&](const auto& reason) { return reason.find(words) != std::string::npos; });
}

constexpr const char* kGravity = "gravity: [0, 0, -9.81 m/s^2]";

TEST(Explanation, SaysWhyThePapersRobotIsSoCheap) {
  const auto reasons = reasons_of(robot_with(kGravity, kGravity));
  EXPECT_TRUE(says(reasons, "C is constant, so C-dot"));
  EXPECT_TRUE(says(reasons, "The potential does not depend on q1: gravity is parallel"));
  EXPECT_TRUE(says(reasons, "The mass matrix is block diagonal in the rates {psi1'}"));
  EXPECT_TRUE(says(reasons, "link 5 has no moment of inertia about x"));
  EXPECT_TRUE(says(reasons, "payload is a point mass"));
  EXPECT_TRUE(says(reasons, "6 joint angles come down to 3 sine/cosine pairs"));
  EXPECT_TRUE(says(reasons, "Parameters (payload) stay variable"));
  EXPECT_TRUE(says(reasons, "No external loads"));
}

TEST(Explanation, SaysNothingThatIsNotSo) {
  EXPECT_FALSE(says(reasons_of(robot_with(kGravity, "gravity: [1, 0, -9.81 m/s^2]")),
                    "does not depend on q1: gravity"));
  EXPECT_FALSE(says(reasons_of(robot_with("q1: psi1 / r1", "q1: psi1 / r1 + psi1^2/1000")), "C is constant"));
  EXPECT_FALSE(says(reasons_of(robot_with("inertia: {xx: 0, yy: 0.004", "inertia: {xx: 0.001, yy: 0.004")),
                    "link 5 has no"));
}

TEST(Explanation, CountsTheLiteralProcedureAndTheProgramPerQuantity) {
  const Explanation explanation = explain(robot_with(kGravity, kGravity));
  ASSERT_EQ(explanation.quantities.size(), kPurposes.size());
  for (const auto& quantity : explanation.quantities) {
    EXPECT_LT(10 * quantity.run.flops(), quantity.literal.flops()) << name_of(quantity.purpose);
    EXPECT_LE(quantity.run.sincos, 3u) << name_of(quantity.purpose);
    EXPECT_EQ(quantity.evaluation, Evaluation::machine_code) << name_of(quantity.purpose);
  }
  EXPECT_EQ(explanation.quantities[0].tracing, Tracing::harmonic);
  EXPECT_GT(explanation.quantities[0].set_up.flops(), 0u);  // the payload's share
}

TEST(Explanation, SaysHowALongChainIsTracedAndRun) {
  const Explanation explanation = explain(scene_of(oracle::serial_chain(12)));
  EXPECT_EQ(explanation.quantities[0].tracing, Tracing::articulated);
  EXPECT_EQ(explanation.quantities[0].evaluation, Evaluation::machine_code);
  EXPECT_TRUE(says(explanation.reasons, "by articulated bodies"));
  const auto& linearisation = explanation.quantities[static_cast<std::size_t>(Purpose::linearisation)];
  EXPECT_TRUE(says(explanation.reasons, "linearisation takes more than"));
  EXPECT_EQ(linearisation.evaluation, Evaluation::interpreter);
}

TEST(Explanation, SaysThatNothingIsCompiledWithoutACompiler) {
  ::setenv("MIXLOOP_CXX", "", 1);
  const Explanation explanation = explain(robot_with(kGravity, kGravity));
  ::unsetenv("MIXLOOP_CXX");
  for (const auto& quantity : explanation.quantities)
    EXPECT_EQ(quantity.evaluation, Evaluation::interpreter) << name_of(quantity.purpose);
  EXPECT_TRUE(says(explanation.reasons, "Here all programs are interpreted: no C++ compiler"));
}

// As many transforms as a scene may have, all turned by one motor: each moves all those after it.
TEST(Explanation, OfTheLongestChainOfOneMotorGrowsWithItsLength) {
  const auto count = [](int links) {
    const auto explanation = explain(scene_of(oracle::coiled_chain(links)));
    for (const auto& quantity : explanation.quantities)
      EXPECT_TRUE(quantity.evaluation && quantity.evaluation != Evaluation::reference)
          << name_of(quantity.purpose);
    return explanation.quantities[0].run.flops();
  };
  const std::size_t half = count(500), whole = count(1000);
  EXPECT_LT(whole, 2.05 * static_cast<double>(half));
}

TEST(Explanation, OfWhatIsTooLongToTraceSaysThatItIsEvaluatedAsWritten) {
  const Explanation explanation = explain(scene_of(oracle::coiled_chain(450, 64)));
  const auto& matrix = explanation.quantities[static_cast<std::size_t>(Purpose::mass_matrix)];
  EXPECT_EQ(matrix.evaluation, Evaluation::reference);
  EXPECT_EQ(matrix.run.flops(), matrix.literal.flops());
  EXPECT_TRUE(says(explanation.reasons, "mass_matrix takes more than 1048576 operations: evaluated as"));
  const auto& bias = explanation.quantities[static_cast<std::size_t>(Purpose::bias)];
  EXPECT_EQ(bias.evaluation, Evaluation::interpreter);
}

TEST(Equations, ThatAreTooLongToTraceAreEvaluatedAsWritten) {
  const auto scene = scene_of(oracle::coiled_chain(450, 64));
  const std::vector<double> psi(64, 0.5), psid(64, 0.25);
  Equations::Workspace reference(equations_of(scene, Evaluation::reference, {Purpose::mass_matrix}), {});
  std::vector<double> expected = reference.outputs(Purpose::mass_matrix), found = expected;
  EXPECT_EQ(reference.evaluate(Purpose::mass_matrix, {psi, psid, {}}, expected), Status::ok);
  for (Evaluation how : {Evaluation::machine_code, Evaluation::interpreter}) {
    Equations::Workspace dynamics(equations_of(scene, how, {Purpose::mass_matrix, Purpose::bias}), {});
    EXPECT_EQ(dynamics.equations().evaluation(), Evaluation::reference);
    EXPECT_EQ(dynamics.evaluate(Purpose::mass_matrix, {psi, psid, {}}, found), Status::ok);
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace mixloop
