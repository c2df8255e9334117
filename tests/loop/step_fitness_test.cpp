// SPDX-License-Identifier: MIT
// Steps are judged by what they make of motions known in closed form.
#include "loop/step_fitness.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

/// x'' = -omega^2 x - rate x'
std::vector<LinearPlant> oscillator(double omega, double rate = 0) {
  std::vector<LinearPlant> plants(1);
  plants[0].A = Matrix::Zero(2, 2);
  plants[0].A(0, 1) = 1;
  plants[0].A(1, 0) = -omega * omega;
  plants[0].A(1, 1) = -rate;
  return plants;
}

std::optional<Misfit> of(Method method, int substeps, const std::vector<LinearPlant>& plants,
                         std::int64_t ticks = 1000, const MotionTolerance& tolerance = {}) {
  return misfit({method, substeps, 0}, {1e-3, ticks, true}, plants, tolerance);
}

// RK4 of an oscillation of one radian a step: |R| = |1 + z + z^2/2 + z^3/6 + z^4/24| at z = i,
// |R|^2 = 1 - 1/72 + 1/576.
TEST(StepFitness, SeesThatAnOscillationDiesOfItsSteps) {
  const auto worst = of(Method::rk4, 1, oscillator(1000));
  ASSERT_TRUE(worst);
  EXPECT_NEAR(std::norm(worst->step), 1 - 1.0 / 72 + 1.0 / 576, 1e-9);
  EXPECT_NEAR(std::abs(worst->truth), 1, 1e-12);
  EXPECT_FALSE(worst->grows());
  EXPECT_GT(worst->error, 0.99);
}

TEST(StepFitness, SeesADamperPastTheMethodsLimit) {
  for (const MethodFacts& method : all_methods()) {
    SCOPED_TRACE(method.name);
    if (method.damper == HUGE_VAL) {
      EXPECT_FALSE(of(method.method, 1, oscillator(0, 1e5)));
      continue;
    }
    // The first of leapfrog's steps, and a tick's only one, is 1 + z + z^2/2.
    const double past = 1.2e3 * (method.method == Method::leapfrog ? 2 : method.damper);
    const auto worst = of(method.method, 1, oscillator(0, past));
    ASSERT_TRUE(worst);
    EXPECT_TRUE(worst->grows());
    EXPECT_NEAR(worst->pole.real(), -past, 1e-6 * past);
    EXPECT_FALSE(of(method.method, 16, oscillator(0, past)));
  }
}

// A phase that runs ahead, the amplitude kept: leapfrog's is (h omega)^3 / 24 a step, here 1e3 * 0.1^3 / 24.
TEST(StepFitness, SeesAnOscillationFallOutOfStep) {
  const auto worst = of(Method::leapfrog, 1, oscillator(100), 1024);
  ASSERT_FALSE(worst) << "4 % of the amplitude";
  const auto later = of(Method::leapfrog, 1, oscillator(100), 4096);
  ASSERT_TRUE(later);
  EXPECT_NEAR(later->error, 4096 * 1e-3 / 24, 0.01);
}

// What decays within a tick is no error, however badly its decay is followed.
TEST(StepFitness, LetsPassWhatDecaysAnyway) {
  EXPECT_FALSE(of(Method::rk4, 8, oscillator(0, 15200)));
  EXPECT_FALSE(of(Method::rk4, 1, oscillator(0, 2000)));
}

// A free body's two poles at zero meet: their eigenvalues' rounding is no motion.
TEST(StepFitness, KnowsAFreeBody) {
  for (const MethodFacts& method : all_methods())
    EXPECT_FALSE(of(method.method, 1, oscillator(0), 1'000'000)) << method.name;
}

TEST(StepFitness, LeavesErrorControlAlone) {
  EXPECT_FALSE(misfit({Method::dop853, 1, 1e-9}, {1e-3, 1000, true}, oscillator(1e5)));
}

TEST(StepFitness, NamesTheStepsAndTheMethodThatServe) {
  const IntegratorSettings steps{Method::rk4, 1, 0};
  for (const bool ideal : {true, false}) {
    const StepTask task{1e-3, 1000, ideal};
    const auto plants = oscillator(0, 5000);
    const auto worst = misfit(steps, task, plants);
    ASSERT_TRUE(worst);
    const std::string said = describe(*worst, steps, task, plants);
    EXPECT_NE(said.find("its pole at -5000 1/s grows 13.7"), std::string::npos) << said;
    EXPECT_NE(said.find("plant.substeps: 2"), std::string::npos) << said;
    EXPECT_EQ(said.find("rodas4") != std::string::npos, ideal) << said;
  }
}

}  // namespace
}  // namespace mixloop
