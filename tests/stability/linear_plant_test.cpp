// SPDX-License-Identifier: MIT
// x' = A x + B u of a plant with a free coordinate, against what is published of it.
#include <gtest/gtest.h>

#include "dynamics/assembly/load_scene.hpp"
#include "stability/linear_loop.hpp"

namespace mixloop {
namespace {

Experiment of_scene(const std::string& name) {
  Experiment experiment;
  experiment.scene = experiment.controller_scene =
      std::make_shared<const Scene>(load_scene(MIXLOOP_SOURCE "/scenes/" + name + ".yaml"));
  experiment.evaluation = Evaluation::interpreter;
  experiment.controller = {.law = Law::torque};
  return experiment;
}

LinearPlant plant_at(const std::string& name, const Vector& psi) {
  const Vector rest = Vector::Zero(psi.size());
  return Linearisation(of_scene(name)).plant_at({psi, rest, rest}, 0);
}

// Control Tutorials for MATLAB and Simulink, Inverted Pendulum: System Modeling; the four decimals printed
// there, and the quotients that they are of.
TEST(LinearPlant, OfTheCartPoleIsThePublishedOne) {
  const LinearPlant plant = plant_at("cart_pole", Vector::Zero(2));
  const double M = 0.5, m = 0.2, b = 0.1, l = 0.3, I = 0.006, g = 9.8;
  const double p = I * (M + m) + M * m * l * l;
  const Matrix A{{0, 0, 1, 0},
                 {0, 0, 0, 1},
                 {0, m * m * g * l * l / p, -(I + m * l * l) * b / p, 0},
                 {0, m * g * l * (M + m) / p, -m * l * b / p, 0}};
  const Matrix B{{0}, {0}, {(I + m * l * l) / p}, {m * l / p}};
  EXPECT_TRUE(plant.A.isApprox(A, 1e-14)) << plant.A;
  EXPECT_TRUE(plant.B.isApprox(B, 1e-14)) << plant.B;
  const auto near = [](double value, double printed) { EXPECT_NEAR(value, printed, 5e-5); };
  near(plant.A(2, 1), 2.6727), near(plant.A(2, 2), -0.1818), near(plant.A(3, 1), 31.1818);
  near(plant.A(3, 2), -0.4545), near(plant.B(2, 0), 1.8182), near(plant.B(3, 0), 4.5455);
  EXPECT_EQ(plant.torque.size(), 1);
  EXPECT_LT(plant.free_torque.cwiseAbs().maxCoeff(), 1e-15);
}

// Beside upright the pole doesn't stay: m g l sin(0.5) would hold it.
TEST(LinearPlant, TellsWhatFreeCoordinatesLack) {
  const LinearPlant plant = plant_at("cart_pole", Vector{{0, 0.5}});
  EXPECT_NEAR(plant.free_torque[0], -0.2 * 9.8 * 0.3 * std::sin(0.5), 1e-14);
  EXPECT_NEAR(plant.torque[0], 0, 1e-14);
}

// Lagrange's equations by hand, about the upright pendulum.
TEST(LinearPlant, OfTheFurutaPendulumIsThatByHand) {
  const double m2 = 0.075, l2 = 0.148, L1 = 0.278, g = 9.81;
  const Eigen::Matrix2d M{{0.0248 + 0.3 * 0.15 * 0.15 + m2 * L1 * L1, m2 * L1 * l2},
                          {m2 * L1 * l2, 0.00386 + m2 * l2 * l2}};
  const Eigen::Matrix2d fall{{0, 0}, {0, m2 * g * l2}}, damping{{1e-4, 0}, {0, 2.8e-4}};
  const LinearPlant plant = plant_at("furuta_pendulum", Vector::Zero(2));
  const Eigen::Matrix2d by_psi = M.inverse() * fall, by_psid = -M.inverse() * damping;
  EXPECT_TRUE(plant.A.bottomLeftCorner(2, 2).isApprox(by_psi, 1e-13)) << plant.A;
  EXPECT_TRUE(plant.A.bottomRightCorner(2, 2).isApprox(by_psid, 1e-13)) << plant.A;
  EXPECT_TRUE(plant.B.bottomRows(2).isApprox(M.inverse().col(0), 1e-13)) << plant.B;
}

}  // namespace
}  // namespace mixloop
