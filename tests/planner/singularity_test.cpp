// SPDX-License-Identifier: MIT
#include "planner/singularity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/inverse_kinematics.hpp"
#include "tests/planner/mechanisms.hpp"

namespace mixloop {
namespace {

/// The first passage of one measure over steps 0 to 10.
std::optional<Passage> passage_of(const std::function<double(double)>& measure) {
  std::vector<double> samples;
  for (int i = 0; i <= 10; ++i) samples.push_back(measure(i));
  return first_passage(samples, 1, [&](double step, double* value) { *value = measure(step); });
}

TEST(FirstPassage, LetsThroughWhatStaysAway) {
  EXPECT_FALSE(passage_of([](double) { return 1.0; }));
  EXPECT_FALSE(passage_of([](double x) { return 0.002 + std::abs(x - 3.4); }));
  EXPECT_FALSE(passage_of([](double x) { return 1.1e-3 + 1e-5 * (x - 4.5) * (x - 4.5); }));
}

TEST(FirstPassage, FindsACrossingBetweenSteps) {
  const auto passage = passage_of([](double x) { return 3.25 - x; });
  ASSERT_TRUE(passage);
  EXPECT_TRUE(passage->crosses);
  EXPECT_NEAR(passage->step, 3.25, 1e-12);
}

// Twice through zero between two samples that see nothing of it.
TEST(FirstPassage, FindsADoubleCrossingWithinAStep) {
  const auto passage = passage_of([](double x) { return (x - 5.4) * (x - 5.6); });
  ASSERT_TRUE(passage);
  EXPECT_TRUE(passage->crosses);
  EXPECT_NEAR(passage->step, 5.4, 1e-12);
}

TEST(FirstPassage, FindsADipWithinAStep) {
  for (const double center : {0.3, 4.5, 9.9}) {
    const auto passage = passage_of([&](double x) { return 5e-4 + std::abs(x - center); });
    ASSERT_TRUE(passage) << center;
    EXPECT_FALSE(passage->crosses);
    EXPECT_NEAR(passage->step, center, 1e-9);
    EXPECT_NEAR(passage->value, 5e-4, 1e-9);
  }
}

TEST(FirstPassage, TellsOfAStartOnTheOtherSide) {
  const auto passage = passage_of([](double) { return -0.5; });
  ASSERT_TRUE(passage);
  EXPECT_TRUE(passage->crosses);
  EXPECT_EQ(passage->step, 0);
}

TEST(FirstPassage, PrefersTheOneThatTheSceneNames) {
  std::vector<double> samples;
  for (int i = 0; i <= 10; ++i) samples.insert(samples.end(), {4.5 - i, 4.4 - i});
  const auto both = [](double step, double* values) { values[0] = 4.5 - step, values[1] = 4.4 - step; };
  EXPECT_EQ(first_passage(samples, 2, both)->measure, 0U);
}

TEST(SingularityMeasures, AreOneAtHomeAndVanishWhereTheSceneSays) {
  const auto model = paper_robot();
  InverseKinematics ik(model);
  SingularityMeasures measures(model, ik.motor_scale(), std::vector<int>{});
  ASSERT_EQ(measures.count(), 4U);
  EXPECT_EQ(measures.name(0), "'flat elbow'");
  double values[4];
  const Vector home = Eigen::Map<const Vector>(model.scene->home.data(), 3);
  measures.evaluate(home, 0, values);
  for (const double value : values) EXPECT_DOUBLE_EQ(value, 1);
  EXPECT_TRUE(measures.on_home_branch(home, 0));

  const auto& arm = *ik.arm();
  measures.evaluate(arm.motors({0, 0.5, 0}), 0, values);  // stretched
  EXPECT_NEAR(values[0], 0, 1e-14);
  EXPECT_NEAR(values[3], 0, 1e-14);
  measures.evaluate(arm.motors({1, 1, std::numbers::pi - 2}), 0, values);  // over the base axis
  EXPECT_NEAR(values[2], 0, 1e-14);
  EXPECT_NEAR(values[3], 0, 1e-14);
  EXPECT_FALSE(measures.on_home_branch(arm.motors({1, 1, std::numbers::pi - 1.9}), 0));
}

// Of a 2 R arm |J^-1| in the Frobenius norm is by hand sqrt(3 + 2 cos b) / |sin b| for links of 1 m.
TEST(SingularityMeasures, OfTheJacobianIsItsInversesNorm) {
  const auto model = model_from(kPlanarArm);
  SingularityMeasures measures(model, Vector::Ones(2), std::vector<int>{});
  double values[2];
  for (const double b : {0.3, 1.0, -2.0}) {
    measures.evaluate(Eigen::Vector2d(0.7, b), 0, values);
    EXPECT_NEAR(values[1], std::sin(b) / std::sqrt(3 + 2 * std::cos(b)) * std::sqrt(3), 1e-15);
    EXPECT_NEAR(values[0], std::sin(b), 1e-15);
  }
}

}  // namespace
}  // namespace mixloop
