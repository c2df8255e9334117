// SPDX-License-Identifier: MIT
// The procedure on the paper's robot, against the closed form, the multipliers and the printed state.
#include <random>

#include <gtest/gtest.h>

#include "tests/dynamics/procedure/scene_procedure.hpp"
#include "tests/oracles/in_wide.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/paper_tree.hpp"

namespace mixloop {
namespace {

using Vector3 = Eigen::Vector3d;
using VectorX = oracle::VectorX<double>;

const Scene& paper_scene() {
  static const Scene scene = load_scene(std::filesystem::path(MIXLOOP_SCENES "/mixed_loop_robot.yaml"));
  return scene;
}

struct Pose {
  Vector3 psi, psid, input;
};

/// Motor angles, rates and torques well past those of the paper's path.
Pose random_state(std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(-30, 30), rate(-40, 40), torque(-5, 5);
  const auto draw = [&](auto& from) { return Vector3(from(random), from(random), from(random)); };
  return {draw(angle), draw(rate), draw(torque)};
}

TEST(Procedure, GivesEveryPrintedDigitOfTheReferenceState) {
  Procedure<double> robot(paper_scene());
  const Vector3 psi(1, 2, 3), psid(0.1, 0.2, 0.3);
  const auto M = robot.mass(psi);
  // One unit of the last printed digit.
  EXPECT_NEAR(M(0, 0), 2.86550198957870e-3, 1e-17);
  EXPECT_NEAR(M(0, 1), -3.29814230930174e-4, 1e-18);
  EXPECT_NEAR(M(0, 2), 4.53116513172736e-6, 1e-18);  // what the terms of M12, 100 times larger, leave
  EXPECT_NEAR(M(1, 1), 8.44291084783174e-3, 1e-17);
  EXPECT_NEAR(M(1, 2), -7.56340623201794e-3, 1e-17);
  EXPECT_NEAR(M(2, 2), 7.551323125e-3, 1e-12);
  const auto h = robot.h(psi, psid);
  EXPECT_NEAR(h[0], 0.154094718617371, 1e-15);
  EXPECT_NEAR(h[1], 1.39472952783717, 1e-14);
  EXPECT_NEAR(h[2], -1.80565290181932, 1e-14);
  const auto E = robot.end(psi, psid, Vector3::Zero()).position;
  EXPECT_NEAR(E[0], 0.0109567571316184, 1e-16);
  EXPECT_NEAR(E[1], 0.00137677281379405, 1e-16);
  EXPECT_NEAR(E[2], 0.355576736892400, 1e-15);
}

// Natural scales: for torques the largest of tau, for accelerations the largest of psidd. 1e-12 leaves M's
// condition number (up to 600) a factor of ten over the rounding of the angles.
TEST(Procedure, AgreesWithTheClosedFormOverTenThousandStates) {
  using Extended = long double;  // 64 bits of mantissa: 1e-16 after M's condition number
  using ExtendedVector = oracle::MixedLoopRobot<Extended>::Vector3;
  Procedure<double> robot(paper_scene());
  const oracle::MixedLoopRobot<Extended> closed_form(oracle::paper_numbers<Extended>());
  std::mt19937_64 random(20260215);
  double worst_forward = 0, worst_inverse = 0;
  for (int sample = 0; sample < 10000; ++sample) {
    const auto [psi, psid, input] = random_state(random);
    const auto extended = [](const Vector3& x) -> ExtendedVector { return x.cast<Extended>(); };
    const auto error = [&](const VectorX& actual, const ExtendedVector& expected) {
      return static_cast<double>((extended(actual) - expected).cwiseAbs().maxCoeff() /
                                 expected.cwiseAbs().maxCoeff());
    };
    const double forward =
        error(robot.forward(psi, psid, input),
              closed_form.forward_dynamics(extended(psi), extended(psid), extended(input)));
    const double inverse =
        error(robot.inverse(psi, psid, input),
              closed_form.inverse_dynamics(extended(psi), extended(psid), extended(input)));
    worst_forward = std::max(worst_forward, forward);
    worst_inverse = std::max(worst_inverse, inverse);
    ASSERT_LT(forward, 1e-12) << "sample " << sample << ", psi " << psi.transpose();
    ASSERT_LT(inverse, 1e-12) << "sample " << sample << ", psi " << psi.transpose();
  }
  RecordProperty("worst_forward", std::to_string(worst_forward * 1e15) + "e-15");
  RecordProperty("worst_inverse", std::to_string(worst_inverse * 1e15) + "e-15");
}

TEST(Procedure, AgreesWithTheClosedFormForEveryPayload) {
  std::mt19937_64 random(6);
  for (const double payload : {0.0, 0.5, 3.0, 20.0}) {
    Procedure<double> robot(paper_scene(), {payload});
    const oracle::MixedLoopRobot<double> closed_form(oracle::paper_numbers(payload, 9.81));
    for (int sample = 0; sample < 100; ++sample) {
      const auto [psi, psid, tau] = random_state(random);
      const Vector3 expected = closed_form.forward_dynamics(psi, psid, tau);
      // Lighter arms have accelerations further above those of their terms: M's condition number reaches 1e4.
      EXPECT_LT((robot.forward(psi, psid, tau) - expected).norm(), 1e-11 * expected.norm()) << payload;
    }
  }
}

TEST(Procedure, AgreesWithLagrangeMultipliersOnTheSameTree) {
  Procedure<double> robot(paper_scene());
  const auto tree = oracle::paper_tree<double>(5.0, 9.81);
  std::mt19937_64 random(8);
  for (int sample = 0; sample < 500; ++sample) {
    const auto [psi, psid, tau] = random_state(random);
    const auto constraints = oracle::paper_constraints<double>(VectorX(psi), VectorX(psid));
    const auto solution = oracle::multiplier_forward_dynamics<double>(tree, constraints, VectorX(tau));
    const VectorX actual = robot.forward(psi, psid, tau);
    EXPECT_LT((actual - solution.psidd).norm(), 1e-10 * solution.psidd.norm()) << "sample " << sample;
  }
}

// In 113 bits the only differences left are the scene's decimals, rounded to doubles (1e-16).
TEST(Procedure, AgreesWithTheClosedFormInWideFloats) {
  using WideVector3 = oracle::MixedLoopRobot<Wide>::Vector3;
  Procedure<Wide> robot(paper_scene());
  const oracle::MixedLoopRobot<Wide> closed_form(oracle::paper_numbers<Wide>());
  std::mt19937_64 random(9);
  for (int sample = 0; sample < 20; ++sample) {
    const auto [psi, psid, tau] = random_state(random);
    const auto wide = [](const Vector3& x) -> WideVector3 {
      return WideVector3(Wide(x[0]), Wide(x[1]), Wide(x[2]));
    };
    const WideVector3 expected = closed_form.forward_dynamics(wide(psi), wide(psid), wide(tau));
    const WideVector3 actual = robot.forward(wide(psi), wide(psid), wide(tau));
    EXPECT_LT(static_cast<double>(Wide((actual - expected).norm() / expected.norm())), 1e-13);
  }
}

TEST(Procedure, EndEffectorMovesAsTheClosedFormSays) {
  Procedure<double> robot(paper_scene());
  const oracle::MixedLoopRobot<double> closed_form(oracle::paper_numbers<double>());
  std::mt19937_64 random(10);
  for (int sample = 0; sample < 200; ++sample) {
    const auto [psi, psid, psidd] = random_state(random);
    const auto end = robot.end(psi, psid, psidd);
    EXPECT_LT((end.position - closed_form.end_effector(psi)).norm(), 1e-14);
    EXPECT_LT((end.velocity - closed_form.end_effector_velocity(psi, psid)).norm(), 1e-12);  // of 10 m/s
    EXPECT_LT((end.acceleration - closed_form.end_effector_acceleration(psi, psid, psidd)).norm(), 1e-10);
    EXPECT_LT((end.jacobian - closed_form.end_effector_jacobian(psi)).norm(), 1e-15);
    const auto energy = robot.energies(psi, psid);
    const auto expected = closed_form.energy(psi, psid);
    EXPECT_NEAR(energy.kinetic, expected.kinetic, 1e-13 * expected.kinetic);
    EXPECT_NEAR(energy.potential, expected.potential, 1e-12);
  }
}

}  // namespace
}  // namespace mixloop
