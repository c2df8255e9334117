// SPDX-License-Identifier: MIT
#include "dynamics/program/explanation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "dynamics/scene/load_scene.hpp"
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
    EXPECT_TRUE(quantity.compiled) << name_of(quantity.purpose);
  }
  EXPECT_EQ(explanation.quantities[0].tracing, Tracing::harmonic);
  EXPECT_GT(explanation.quantities[0].set_up.flops(), 0u);  // the payload's share
}

TEST(Explanation, SaysHowALongChainIsTracedAndRun) {
  const Explanation explanation = explain(scene_of(oracle::serial_chain(12)));
  EXPECT_EQ(explanation.quantities[0].tracing, Tracing::articulated);
  EXPECT_TRUE(explanation.quantities[0].compiled);
  EXPECT_TRUE(says(explanation.reasons, "by articulated bodies"));
  const auto& linearisation = explanation.quantities[static_cast<std::size_t>(Purpose::linearisation)];
  EXPECT_EQ(linearisation.compiled, !says(explanation.reasons, "linearisation takes more than"));
  EXPECT_FALSE(linearisation.compiled);
}

}  // namespace
}  // namespace mixloop
