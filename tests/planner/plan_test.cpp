// SPDX-License-Identifier: MIT
#include "planner/plan.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/planner/mechanisms.hpp"
#include "tests/support/allocation_counter.hpp"

namespace mixloop {
namespace {

using Eigen::Vector3d;

/// Whether two references have the same bytes.
bool same_bytes(const Reference& a, const Reference& b) {
  const std::size_t size = reference_size(static_cast<int>(a.psi.size())) * sizeof(double);
  return std::memcmp(a.psi.data(), b.psi.data(), size) == 0;
}

/// Holds each reference of a plan against forward kinematics at its time: what is desired of the end effector
/// is what the desired motors do.
void expect_consistent(const Model<double>& model, const Plan& plan, double rate_hz) {
  Workspace<double> ws(model);
  for (std::int64_t k = 0; k <= plan.ticks(); ++k) {
    const Reference reference = plan.at(k);
    const Vector psi = reference.psi, psid = reference.psid, psidd = reference.psidd;
    const auto& E = end_effector<double>(model, span_of(psi), span_of(psid), span_of(psidd),
                                         static_cast<double>(k) / rate_hz, ws);
    // Rounding, times condition numbers up to a hundred.
    ASSERT_LT((E.position - reference.position).norm(), 1e-14) << k;
    ASSERT_LT((E.velocity - reference.velocity).norm(), 1e-13 * (1 + reference.velocity.norm())) << k;
    ASSERT_LT((E.acceleration - reference.acceleration).norm(), 1e-12 * (1 + reference.acceleration.norm()))
        << k;
  }
}

TEST(Plan, TracksThePapersLineOnThePapersBranch) {
  const auto model = paper_robot();
  const Plan plan = plan_of(model, kPaperPath);
  EXPECT_EQ(plan.ticks(), 1000);
  EXPECT_EQ(plan.start_tick(), 0);
  expect_consistent(model, plan, 1000);
  EXPECT_EQ(Vector3d(plan.at(0).position), Vector3d(0.3, 0, 0.8));
  EXPECT_EQ(Vector3d(plan.at(1000).position), Vector3d(-0.3, 0.4, 0.3));
  EXPECT_EQ(Vector3d(plan.at(500).position), Vector3d(0, 0.2, 0.55));
  EXPECT_EQ(plan.at(0).psid.norm(), 0);
  EXPECT_EQ(plan.at(1000).psidd.norm(), 0);

  Workspace<double> ws(model);
  double most = 0, least = 180, s_of_most = 0;
  for (int k = 0; k <= 1000; ++k) {
    const Vector psi = plan.at(k).psi;
    coordinates<double>(model, span_of(psi), 0.0, ws);
    const double q5_deg = ws.q[4] * 180 / std::numbers::pi;
    least = std::min(least, q5_deg);
    if (q5_deg > most) most = q5_deg, s_of_most = (0.3 - plan.at(k).position[0]) / 0.6;
    if (k == 0) {
      EXPECT_NEAR(q5_deg, 27.27, 0.005);
    }
  }
  EXPECT_NEAR(most, 116.43, 0.005);
  EXPECT_NEAR(s_of_most, 0.558, 0.001);
  EXPECT_GT(least, 27);
}

TEST(Plan, HoldsTheEndPastItsEnd) {
  const Plan plan = plan_of(paper_robot(), kPaperPath);
  for (const std::int64_t k :
       {std::int64_t{1001}, std::int64_t{1} << 40, std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(Vector(plan.at(k).psi), Vector(plan.at(1000).psi));
    EXPECT_EQ(Vector3d(plan.at(k).position), Vector3d(-0.3, 0.4, 0.3));
    EXPECT_EQ(plan.at(k).psid.norm() + plan.at(k).psidd.norm() + plan.at(k).velocity.norm() +
                  plan.at(k).acceleration.norm(),
              0);
  }
  EXPECT_TRUE(same_bytes(plan.at(-1), plan.at(0)));
  EXPECT_TRUE(same_bytes(plan.at(std::numeric_limits<std::int64_t>::min()), plan.at(0)));
}

TEST(Plan, GivesTheSameBytesAtATickForAnyNumberOfStages) {
  const auto model = paper_robot();
  const Plan ticks = plan_of(model, kPaperPath);
  for (const int stages : {2, 6}) {
    const Plan staged = plan_of(model, kPaperPath, {.stages_per_tick = stages});
    EXPECT_EQ(staged.ticks(), 1000);
    for (int k = 0; k <= 1000; ++k) EXPECT_TRUE(same_bytes(staged.at_stage(k, 0), ticks.at(k))) << k;
    const Plan fine = plan_of(model, kPaperPath, {.rate_hz = 1000.0 * stages});
    for (int k = 0; k < 1000; ++k)
      EXPECT_TRUE(same_bytes(staged.at_stage(k, 1), fine.at(stages * k + 1))) << k;
  }
}

// Rows within a step, an integrator's stages, are the path at their times.
TEST(Plan, HasRowsWithinAStep) {
  const auto model = paper_robot();
  const Plan ticks = plan_of(model, kPaperPath);
  const Plan within = plan_of(model, kPaperPath, {.stages_per_tick = 2, .within = {0, 0.25, 0.75}});
  const Plan fine = plan_of(model, kPaperPath, {.rate_hz = 8000});
  for (int k = 0; k < 1000; ++k) {
    EXPECT_TRUE(same_bytes(within.at_stage(k, 0), ticks.at(k))) << k;
    for (const auto& [row, eighth] : {std::pair{1, 1}, {2, 3}, {3, 4}, {4, 5}, {5, 7}})
      EXPECT_TRUE(same_bytes(within.at_stage(k, row), fine.at(8 * k + eighth))) << k << " row " << row;
    EXPECT_TRUE(same_bytes(within.at_stage(k, 6), ticks.at(k + 1))) << k;
  }
}

TEST(Plan, RepeatsALapWithTheSameBytes) {
  const auto model = paper_robot();
  const Plan plan =
      plan_of(model, "{line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, duration: 1 s, repeat: 5}");
  EXPECT_EQ(plan.ticks(), 10'000);
  for (std::int64_t k = 0; k < 2000; ++k) EXPECT_TRUE(same_bytes(plan.at(k), plan.at(k + 3 * 2000)));
  for (std::int64_t k = 0; k <= 1000; ++k) EXPECT_LT((plan.at(k).psi - plan.at(2000 - k).psi).norm(), 1e-12);
  EXPECT_EQ(Vector3d(plan.at(9000).position), Vector3d(-0.3, 0.4, 0.3));
  EXPECT_EQ(Vector3d(plan.at(10'000).position), Vector3d(0.3, 0, 0.8));
  expect_consistent(model, plan, 1000);
}

TEST(Plan, RestsAtViaPoints) {
  const auto model = paper_robot();
  const Plan plan = plan_of(model,
                            "{via: [{at: [0.3, 0, 0.8]}, {at: [0.1, 0.3, 0.5], duration: 0.6 s, dwell: 0.1 "
                            "s}, {at: [-0.3, 0.4, 0.3], duration: 0.5 s}]}",
                            {.rate_hz = 2000});
  EXPECT_EQ(plan.ticks(), 2400);
  for (int k = 1200; k <= 1400; ++k) {
    EXPECT_EQ(Vector3d(plan.at(k).position), Vector3d(0.1, 0.3, 0.5));
    EXPECT_EQ(plan.at(k).psid.norm() + plan.at(k).psidd.norm(), 0);
  }
  expect_consistent(model, plan, 2000);
}

TEST(Plan, MovesTheMotorsToTheStartFirst) {
  const auto model = paper_robot();
  const std::vector<double> start = {2, -18, 14};
  const Plan at_start = plan_of(model, kPaperPath);
  const Plan plan = plan_of(model, kPaperPath, {.start_psi = start});
  // Without limits no faster than on the path, where the motors reach 39 rad/s: 1 s is enough.
  EXPECT_EQ(plan.start_tick(), 1000);
  EXPECT_EQ(plan.ticks(), 2000);
  EXPECT_EQ(Vector(plan.at(0).psi), Vector(Eigen::Map<const Vector>(start.data(), 3)));
  EXPECT_EQ(plan.at(0).psid.norm() + plan.at(0).psidd.norm(), 0);
  for (int k = 0; k <= 1000; ++k) EXPECT_TRUE(same_bytes(plan.at(1000 + k), at_start.at(k)));
  // Continuous where it joins the path, to the second derivative.
  EXPECT_LT((plan.at(999).psi - plan.at(1000).psi).norm(), 1e-6);
  EXPECT_LT(plan.at(999).psid.norm(), 1e-3);
  EXPECT_LT(plan.at(999).psidd.norm(), 1);
  expect_consistent(model, plan, 1000);

  Path longer = path_from(kPaperPath, model);
  longer.approach = 2.5;
  EXPECT_EQ(Plan(model, longer, {.start_psi = start}).start_tick(), 2500);
  const Vector there = at_start.at(0).psi;
  EXPECT_EQ(Plan(model, longer, {.start_psi = {there.begin(), there.end()}}).start_tick(), 0);
}

TEST(Plan, MovesToTheStartAsFastAsItsLimitsAllow) {
  const auto model = model_from(gantry(false));
  Path path = path_from("{line: {from: [1, 0, 0], to: [1, 1, 0]}, duration: 10 s}", model);
  // 3 m at 0.75 m/s at most: 15/8 * 3 / 0.75 = 7.5 s.
  const Plan plan(model, path, {.limits = {.velocity = {100, 0.75, 100}}, .start_psi = {0, -2, 0}});
  EXPECT_EQ(plan.start_tick(), 7500);
  double most = 0;
  for (int k = 0; k <= 7500; ++k) most = std::max(most, std::abs(plan.at(k).psid[1]));
  EXPECT_NEAR(most, 0.75, 1e-6);
  EXPECT_LE(most, 0.75 * (1 + 1e-9));
}

TEST(Plan, FollowsPlanarAndPrismaticScenes) {
  const auto planar = model_from(kPlanarArm);
  const std::string line = "{line: {from: [1, 0.5], to: [0.5, 1.5]}, duration: 1 s, repeat: 2}";
  expect_consistent(planar, plan_of(planar, line), 1000);
  const auto upright = model_from(kUprightArm);
  expect_consistent(upright, plan_of(upright, line), 1000);
  const auto slides = model_from(gantry(false));
  const Plan plan = plan_of(slides, "{line: {from: [0, 0, 0], to: [1, 2, 0.05]}, duration: 1 s}");
  expect_consistent(slides, plan, 1000);
  EXPECT_NEAR(plan.at(500).psi[0], 5 * std::numbers::pi, 1e-13);  // half of five turns
  EXPECT_DOUBLE_EQ(plan.at(500).psid[1], 2);
}

// The constraints depend on time: no lap is like the other, and the move to the start meets a moving target.
TEST(Plan, FollowsScenesThatMoveByThemselves) {
  const auto model = model_from(gantry(true));
  const std::string path =
      "{line: {from: [0, 0, 0], to: [1, 2, 0.05]}, duration: 0.5 s, repeat: 2, approach: 0.3 s}";
  expect_consistent(model, plan_of(model, path), 1000);
  const Plan plan = plan_of(model, path, {.start_psi = {1, 2, 3}});
  EXPECT_EQ(plan.start_tick(), 300);
  expect_consistent(model, plan, 1000);
  EXPECT_LT((plan.at(299).psid - plan.at(300).psid).norm(), 1e-2);
  EXPECT_LT((plan.at(299).psidd - plan.at(300).psidd).norm(), 20);
  EXPECT_LT((plan.at(300).position).norm(), 1e-15);
}

TEST(Plan, LooksUpWithoutAllocating) {
  if (!AllocationCounter::works()) GTEST_SKIP();
  const Plan plan = plan_of(paper_robot(), kPaperPath);
  double sum = 0;
  AllocationCounter counter;
  for (int k = -5; k < 1010; ++k) sum += plan.at(k).psi[1];
  EXPECT_EQ(counter.count(), 0U);
  EXPECT_NE(sum, 0);
}

}  // namespace
}  // namespace mixloop
