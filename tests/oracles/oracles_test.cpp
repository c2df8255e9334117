// SPDX-License-Identifier: MIT
// The oracles against each other and against the printed reference state.
#include <random>

#include <gtest/gtest.h>

#include "tests/oracles/in_wide.hpp"
#include "tests/oracles/mixed_loop_robot.hpp"
#include "tests/oracles/paper_tree.hpp"
#include "tests/oracles/random_mechanism.hpp"

namespace mixloop::oracle {
namespace {

using Vec3 = Vector3<Wide>;
using Robot = MixedLoopRobot<Wide>;

struct State {
  Vec3 psi, psid, tau;
};

State random_state(std::mt19937_64& random) {
  std::uniform_real_distribution<double> angle(-100, 100), rate(-60, 60), torque(-5, 5);
  const auto draw = [&](auto& from) { return Vec3(from(random), from(random), from(random)); };
  return {draw(angle), draw(rate), draw(torque)};
}

double distance(const auto& left, const auto& right) {
  return static_cast<double>((left - right).cwiseAbs().maxCoeff());
}

const Vec3 kPsi(Wide(1), Wide(2), Wide(3));
const Vec3 kPsid(Wide(1) / 10, Wide(2) / 10, Wide(3) / 10);

// Half a unit of each last printed digit.
TEST(MixedLoopRobot, GivesEveryPrintedDigitOfTheReferenceState) {
  const Robot robot(paper_numbers<Wide>());
  const auto M = robot.mass_matrix(kPsi);
  EXPECT_NEAR(static_cast<double>(M(0, 0)), 2.86550198957870e-3, 0.51e-17);
  EXPECT_NEAR(static_cast<double>(M(0, 1)), -3.29814230930174e-4, 0.51e-18);
  EXPECT_NEAR(static_cast<double>(M(0, 2)), 4.53116513172736e-6, 0.51e-20);
  EXPECT_NEAR(static_cast<double>(M(1, 1)), 8.44291084783174e-3, 0.51e-17);
  EXPECT_NEAR(static_cast<double>(M(1, 2)), -7.56340623201794e-3, 0.51e-17);
  EXPECT_NEAR(static_cast<double>(M(2, 2)), 7.551323125e-3, 0.51e-12);
  const Vec3 h = robot.bias(kPsi, kPsid);
  EXPECT_NEAR(static_cast<double>(h[0]), 0.154094718617371, 0.51e-15);
  EXPECT_NEAR(static_cast<double>(h[1]), 1.39472952783717, 0.51e-14);
  EXPECT_NEAR(static_cast<double>(h[2]), -1.80565290181932, 0.51e-14);
  const Vec3 E = robot.end_effector(kPsi);
  EXPECT_NEAR(static_cast<double>(E[0]), 0.0109567571316184, 0.51e-16);
  EXPECT_NEAR(static_cast<double>(E[1]), 0.00137677281379405, 0.51e-17);
  EXPECT_NEAR(static_cast<double>(E[2]), 0.355576736892400, 0.51e-15);
}

// Both run in 113 bits (1e-34): what is left after a solve with a condition number below 1e6.
TEST(Oracles, LagrangeAndMultipliersAgreeInWideFloats) {
  std::mt19937_64 random(20260101);
  for (const int payload : {0, 5}) {
    const Robot robot(paper_numbers<Wide>(Wide(payload)));
    const Tree<Wide> tree = paper_tree<Wide>(Wide(payload));
    for (int sample = 0; sample < 50; ++sample) {
      const auto [psi, psid, tau] = random_state(random);
      const auto constraints = paper_constraints<Wide>(psi, psid);
      const auto solution = multiplier_forward_dynamics<Wide>(tree, constraints, tau);
      const Vec3 psidd = robot.forward_dynamics(psi, psid, tau);
      const double scale = static_cast<double>(psidd.norm());
      EXPECT_LT(distance(psidd, solution.psidd), 1e-26 * scale) << "sample " << sample;
      const VectorX<Wide> torque = multiplier_inverse_dynamics<Wide>(tree, constraints, psidd);
      EXPECT_LT(distance(tau, torque), 1e-26 * scale) << "sample " << sample;
      const MatrixX<Wide> M =
          constraints.C.transpose() * tree_mass_matrix(tree, constraints.q) * constraints.C;
      EXPECT_LT(distance(robot.mass_matrix(psi), M), 1e-30);
    }
  }
}

TEST(MixedLoopRobot, InverseDynamicsUndoesForwardDynamics) {
  std::mt19937_64 random(3);
  const Robot robot(paper_numbers<Wide>());
  for (int sample = 0; sample < 50; ++sample) {
    const auto [psi, psid, tau] = random_state(random);
    const Vec3 psidd = robot.forward_dynamics(psi, psid, tau);
    EXPECT_LT(distance(robot.inverse_dynamics(psi, psid, psidd), tau), 1e-28);
  }
}

TEST(MixedLoopRobot, EndEffectorIsTheOriginOfFrameThree) {
  std::mt19937_64 random(5);
  const Robot robot(paper_numbers<Wide>());
  const Tree<Wide> tree = paper_tree<Wide>();
  for (int sample = 0; sample < 50; ++sample) {
    const auto [psi, psid, psidd] = random_state(random);
    const auto state = paper_constraints<Wide>(psi, psid);
    const VectorX<Wide> qdd = state.C * psidd;
    const FrameMotion<Wide> frame = frame_motions<Wide>(tree, state.q, state.qd, qdd)[2];
    EXPECT_LT(distance(robot.end_effector(psi), frame.p), 1e-30);
    EXPECT_LT(distance(robot.end_effector_velocity(psi, psid), frame.v), 1e-30);
    EXPECT_LT(distance(robot.end_effector_acceleration(psi, psid, psidd), frame.acceleration), 1e-29);
    const auto q = robot.dependent(psi);
    for (int i = 0; i < 6; ++i) EXPECT_LT(static_cast<double>(abs(q[i] - state.q[i])), 1e-30);
  }
}

// dT/dt + dV/dt = tau . psi' along the motion; the rate by a central difference of step 1e-10 (error 1e-20).
TEST(MixedLoopRobot, PowerOfTheMotorsIsTheRateOfEnergy) {
  std::mt19937_64 random(7);
  const Robot robot(paper_numbers<Wide>());
  for (int sample = 0; sample < 20; ++sample) {
    const auto [psi, psid, tau] = random_state(random);
    const Vec3 psidd = robot.forward_dynamics(psi, psid, tau);
    const auto energy = [&](const Wide& dt) {
      const auto E = robot.energy(psi + dt * psid + dt * dt / 2 * psidd, psid + dt * psidd);
      return Wide(E.kinetic + E.potential);
    };
    const Wide dt(1e-10), rate = (energy(dt) - energy(-dt)) / (2 * dt);
    EXPECT_NEAR(static_cast<double>(Wide(rate - tau.dot(psid))), 0, 1e-9);
  }
}

// By hand: a 1 m massless pendulum with 2 kg at its tip, gravity 10.
TEST(Multipliers, TinyTreesGiveWholeNumbers) {
  Tree<double> pendulum;
  pendulum.coordinates = 1;
  pendulum.gravity = {0, -10, 0};
  pendulum.frames = {{-1, 0, 0, 1, 0, Motion::revolute, 0, 1}};
  pendulum.bodies = {{0, 2, {0, 0, 0}, Matrix3<double>::Zero()}};
  const VectorX<double> zero = VectorX<double>::Zero(1), one = VectorX<double>::Ones(1);
  EXPECT_DOUBLE_EQ(tree_mass_matrix(pendulum, zero)(0, 0), 2);
  EXPECT_DOUBLE_EQ(tree_bias(pendulum, zero, one)[0], 20);
  pendulum.loads = {{0, {0, 0, 0}, {0, 20, 0}, {0, 0, 0}}};  // the load that carries it
  EXPECT_DOUBLE_EQ(tree_bias(pendulum, zero, one)[0], 0);

  // A gear pair: q = 3 psi turns an inertia of 2 under a motor torque of 36: psi'' = 36 / 18.
  Tree<double> wheel;
  wheel.coordinates = 1;
  wheel.frames = {{-1, 0, 0, 0, 0, Motion::revolute, 0, 1}};
  Matrix3<double> inertia = Matrix3<double>::Zero();
  inertia(2, 2) = 2;
  wheel.bodies = {{0, 0, {0, 0, 0}, inertia}};
  const ConstraintState<double> geared{zero, zero, zero, MatrixX<double>::Constant(1, 1, 3)};
  const auto solution = multiplier_forward_dynamics<double>(wheel, geared, VectorX<double>::Constant(1, 36));
  EXPECT_NEAR(solution.psidd[0], 2, 1e-14);
  EXPECT_NEAR(solution.qdd[0], 6, 1e-14);
  EXPECT_NEAR(solution.multipliers[0], -12, 1e-14);
}

// Rates by central differences along the motion, in 113 bits: step 1e-9, error 1e-18 and 1e-16.
TEST(RandomMechanism, ConstraintDerivativesAreThoseOfTheConstraints) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomMechanism mechanism(seed, {.nonlinear = true, .timed = true});
    const int n = mechanism.n();
    VectorX<Wide> psi(n), psid(n), psidd(n);
    for (int i = 0; i < n; ++i) {
      psi[i] = Wide(i + 1) / 4;
      psid[i] = Wide(2 - i) / 8;
      psidd[i] = Wide(3 * i - 2) / 16;
    }
    const Wide t = Wide(3) / 8, dt(1e-9);
    const auto at = [&](const Wide& h) {
      return mechanism.constraints<Wide>(psi + h * psid + h * h / 2 * psidd, psid + h * psidd, t + h);
    };
    const auto before = at(-dt), now = at(Wide(0)), after = at(dt);
    const VectorX<Wide> qdd = now.C * psidd + now.gamma;
    EXPECT_LT(distance(now.qd, (after.q - before.q) / (2 * dt)), 1e-15) << "seed " << seed;
    EXPECT_LT(distance(qdd, (after.qd - before.qd) / (2 * dt)), 1e-15) << "seed " << seed;
    for (int i = 0; i < n; ++i) {
      const VectorX<Wide> step = dt * VectorX<Wide>::Unit(n, i);
      const VectorX<Wide> column = (mechanism.constraints<Wide>(psi + step, psid, t).q -
                                    mechanism.constraints<Wide>(psi - step, psid, t).q) /
                                   (2 * dt);
      EXPECT_LT(distance(now.C.col(i), column), 1e-15) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace mixloop::oracle
