// SPDX-License-Identifier: MIT
// What a law answers to small deviations, against differences of the law itself in wide floats.
#include "controller/feedback.hpp"

#include <gtest/gtest.h>

#include "planner/reference.hpp"
#include "tests/dynamics/procedure/scene_procedure.hpp"
#include "tests/oracles/in_wide.hpp"

namespace mixloop {
namespace {

using WideVector = oracle::VectorX<Wide>;

std::shared_ptr<const Scene> robot() {
  return std::make_shared<const Scene>(load_scene(MIXLOOP_SOURCE "/scenes/mixed_loop_robot.yaml"));
}

const Vector kPsi = Vector{{1.0, 2.0, 3.0}}, kPsid = Vector{{5.0, -4.0, 3.0}},
             kPsidd = Vector{{40.0, 30.0, -20.0}};

struct Case {
  const char* name;
  Law law;
  FeedforwardAt at;
};

class FeedbackOf : public testing::TestWithParam<Case> {};

// The law's torque at a measured state, by the procedure.
WideVector torque(Procedure<Wide>& model, const ControllerSettings& settings, const WideVector& psi,
                  const WideVector& psid) {
  const WideVector psi_d = kPsi.cast<Wide>(), psid_d = kPsid.cast<Wide>(), psidd_d = kPsidd.cast<Wide>();
  const bool desired = settings.feedforward_at == FeedforwardAt::desired;
  const WideVector at = desired ? psi_d : psi, rate = desired ? psid_d : psid;
  WideVector tau = settings.kp.cast<Wide>().cwiseProduct(psi_d - psi) +
                   settings.kv.cast<Wide>().cwiseProduct(psid_d - psid);
  if (settings.law == Law::pd_feedforward) tau += model.mass(at) * psidd_d;
  if (settings.law == Law::pd_gravity) tau += model.h(at, WideVector::Zero(3));
  if (settings.law == Law::computed_torque) tau += model.inverse(at, rate, psidd_d);
  return tau;
}

// Differences of step 1e-10 in 113 bits err by 1e-20 of the third derivative; the gain is exact but for
// doubles' rounding, some 1e-13 of its terms (kp of 100, condition number of M of 10).
TEST_P(FeedbackOf, IsTheDerivativeOfItsTorque) {
  const auto scene = robot();
  Procedure<Wide> procedure(*scene);
  Equations::Workspace model(
      equations_of(scene, Evaluation::interpreter, {Purpose::inverse_dynamics, Purpose::linearisation}),
      scene->default_parameters());
  ControllerSettings settings;
  settings.law = GetParam().law;
  settings.feedforward_at = GetParam().at;
  settings.kp = Vector{{100.0, 25.0, 25.0}};
  settings.kv = Vector{{1.0, 0.5, 0.5}};
  const Matrix gain = feedback(settings, model, {kPsi, kPsid, kPsidd}, 0).gain();

  const Wide step(1e-10);
  const WideVector psi = kPsi.cast<Wide>(), psid = kPsid.cast<Wide>();
  for (int i = 0; i < 3; ++i) {
    const WideVector e = step * WideVector::Unit(3, i);
    const WideVector by_psi =
        (torque(procedure, settings, psi + e, psid) - torque(procedure, settings, psi - e, psid)) /
        (2 * step);
    const WideVector by_psid =
        (torque(procedure, settings, psi, psid + e) - torque(procedure, settings, psi, psid - e)) /
        (2 * step);
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(gain(row, i), static_cast<double>(by_psi[row]), 1e-11);
      EXPECT_NEAR(gain(row, 3 + i), static_cast<double>(by_psid[row]), 1e-11);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, FeedbackOf,
    testing::Values(Case{"Pd", Law::pd, FeedforwardAt::measured},
                    Case{"PdGravity", Law::pd_gravity, FeedforwardAt::measured},
                    Case{"PdFeedforward", Law::pd_feedforward, FeedforwardAt::measured},
                    Case{"PdFeedforwardAtDesired", Law::pd_feedforward, FeedforwardAt::desired},
                    Case{"ComputedTorque", Law::computed_torque, FeedforwardAt::measured}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace mixloop
