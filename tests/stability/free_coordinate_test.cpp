// SPDX-License-Identifier: MIT
// A loop of which not all coordinates have a motor, linearised.
#include <gtest/gtest.h>

#include "stability/limits.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

Experiment experiment(Law law) {
  Experiment experiment;
  experiment.scene = experiment.controller_scene = crane();
  experiment.evaluation = Evaluation::interpreter;
  experiment.controller = {.law = law, .kp = Vector{{100.0}}, .kv = Vector{{10.0}}};
  return experiment;
}

LinearLoop loop(Law law) {
  const std::vector<double> at_rest(reference_size(1), 0.0);
  return Linearisation(experiment(law)).at(reference_in(at_rest, 1), 0);
}

// At rest, hanging: x'' = (u - 10 swing) / 2, swing'' = x'' - 10 swing.
TEST(LoopOfACrane, HasTwoCoordinatesAndOneMotor) {
  const LinearLoop crane_loop = loop(Law::pd);
  EXPECT_TRUE(crane_loop.A.isApprox(Matrix{{0, 0, 1, 0}, {0, 0, 0, 1}, {0, -5, 0, 0}, {0, -15, 0, 0}}, 1e-14))
      << crane_loop.A;
  EXPECT_TRUE(crane_loop.B.isApprox(Matrix{{0}, {0}, {0.5}, {0.5}}, 1e-14)) << crane_loop.B;
  EXPECT_TRUE(crane_loop.feedback.gain().isApprox(Matrix{{-100, 0, -10, 0}}, 1e-14));
  EXPECT_EQ(sampled_transition(crane_loop, crane_loop.feedback.gain(), {1e-3, 0}).rows(), 5);
  EXPECT_EQ(limits_of(crane_loop, {1e-3, 0}).most_gain_of_motor.size(), 1U);
}

// Whatever of the model is at rest is nothing: the feed-forward's slope is the mass matrix', and it is even.
TEST(LoopOfACrane, HasTheModelsShareForItsMotor) {
  for (const Law law : {Law::pd_gravity, Law::pd_feedforward, Law::computed_torque}) {
    const Matrix model = loop(law).feedback.model;
    EXPECT_EQ(model.rows(), 1);
    EXPECT_EQ(model.cols(), 4);
    EXPECT_LT(model.cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace mixloop
