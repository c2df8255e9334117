// SPDX-License-Identifier: MIT
#include "controller/guarded_controller.hpp"

#include <gmock/gmock.h>

#include "loop/experiment.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

struct Bench {
  explicit Bench(const std::string& safety)
      : experiment(load_experiment(std::filesystem::path(MIXLOOP_EXPERIMENTS "/paper.yaml"),
                                   {{"controller.law", "pd"}, {"controller.safety", safety}})),
        plan(make_plan(experiment)),
        controller(make_guarded_controller(experiment)),
        psi(plan.at(0).psi) {}

  CommandMarks at(double t, bool stale = false) {
    return controller.torque({span_of(std::as_const(psi)), span_of(std::as_const(psid)), t, stale},
                             plan.at(0), span_of(tau));
  }

  Experiment experiment;
  Plan plan;
  GuardedController controller;
  Vector psi, psid = Vector::Zero(3), tau = Vector::Zero(3);
};

// kp = (100, 25, 25).
TEST(GuardedController, KeepsToATorqueLimit) {
  Bench bench("{torque_limit: [2, 1, 1]}");
  EXPECT_FALSE(bench.at(0).limited);
  bench.psi[0] -= 0.01;
  EXPECT_FALSE(bench.at(0).limited);
  EXPECT_NEAR(bench.tau[0], 1, 1e-12);
  bench.psi[0] -= 0.03;
  bench.psi[1] += 0.1;
  EXPECT_TRUE(bench.at(0).limited);
  EXPECT_EQ(bench.tau[0], 2);
  EXPECT_EQ(bench.tau[1], -1);
}

TEST(GuardedController, KeepsToATorqueRate) {
  Bench bench("{torque_rate_limit: [100 N m/s, 100 N m/s, 100 N m/s]}");
  bench.at(0);
  bench.psi[0] -= 0.01;
  EXPECT_TRUE(bench.at(0.001).limited);
  EXPECT_NEAR(bench.tau[0], 0.1, 1e-12);
  EXPECT_TRUE(bench.at(0.005).limited);
  EXPECT_NEAR(bench.tau[0], 0.5, 1e-12) << "a gap of 4 ms";
  EXPECT_FALSE(bench.at(0.010).limited);
  EXPECT_NEAR(bench.tau[0], 1, 1e-12);
}

// Who replays a run knows only the commands that were taken.
TEST(GuardedController, RemembersNothingOfASafeCommandBesideTheLaw) {
  Bench bench("{torque_rate_limit: [100 N m/s, 100 N m/s, 100 N m/s], safe_command: damp}");
  bench.at(0);
  bench.psi[0] -= 0.01;
  Vector safe = Vector::Ones(3);
  bench.controller.safe_torque(span_of(safe));
  EXPECT_EQ(safe, Vector::Zero(3)) << "at rest";
  EXPECT_TRUE(bench.at(0.001).limited);
  EXPECT_NEAR(bench.tau[0], 0.1, 1e-12) << "from the law's own last torque, and since then";
}

TEST(GuardedController, StaysSafeOnceTheStateIsOutOfRange) {
  Bench bench("{velocity_limit: [5 rad/s, 5 rad/s, 5 rad/s], safe_command: damp}");
  bench.psid[1] = 4;
  EXPECT_FALSE(bench.at(0).safe);
  bench.psid[1] = 6;
  EXPECT_TRUE(bench.at(0.001).safe);
  EXPECT_EQ(bench.tau[1], -0.5 * 4) << "kv times the last velocity that was trusted";
  bench.psid[1] = 0;
  EXPECT_TRUE(bench.at(0.002).safe) << "latched";
  EXPECT_EQ(bench.controller.out_of_range(), 2);
  bench.controller.begin();
  EXPECT_FALSE(bench.at(0).safe);
}

TEST(GuardedController, KnowsEachMotorsRange) {
  Bench bench("{position_range: [[-99, 99], [-99, 99], [-99, 99]]}");
  EXPECT_FALSE(bench.at(0).safe);
  bench.psi[2] = 99.5;
  EXPECT_TRUE(bench.at(0).safe);
  EXPECT_EQ(bench.tau.norm(), 0);
}

TEST(GuardedController, IsSafeWhileTheSensorsDoNotDeliver) {
  Bench bench("{max_stale: 2}");
  EXPECT_FALSE(bench.at(0, true).safe);
  EXPECT_FALSE(bench.at(0.001, true).safe);
  EXPECT_TRUE(bench.at(0.002, true).safe);
  EXPECT_FALSE(bench.at(0.003, false).safe) << "back";
}

TEST(GuardedController, RefusesToStartFarAway) {
  Bench bench("{start_tolerance: [0.1, 0.1, 0.1]}");
  EXPECT_EQ(bench.controller.start_refusal(span_of(std::as_const(bench.psi)), bench.plan.at(0)), "");
  bench.psi[1] += 0.11;
  EXPECT_THAT(bench.controller.start_refusal(span_of(std::as_const(bench.psi)), bench.plan.at(0)),
              HasSubstr("motor 2"));
}

class BadSafety : public testing::TestWithParam<BadInput> {};

TEST_P(BadSafety, IsRefused) {
  const auto error = input_error([] { Bench bench(GetParam().text); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(error->message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadSafety,
    testing::Values(
        BadInput{"UnknownKey", "{torque_limits: [1, 1, 1]}", "unknown_key", "torque_limit"},
        BadInput{"NotPositive", "{torque_limit: [1, 0, 1]}", "out_of_range", "positive"},
        BadInput{"TooFew", "{torque_limit: [1, 1]}", "wrong_size", "2 values"},
        BadInput{"EmptyRange", "{position_range: [[1, 1], [0, 1], [0, 1]]}", "out_of_range", "empty"},
        BadInput{"RangeWithoutEnds", "{position_range: [[1], [0, 1], [0, 1]]}", "wrong_size", "two ends"},
        BadInput{"WrongUnit", "{velocity_limit: [5 m, 5 m, 5 m]}", "wrong_dimension", "velocity"},
        BadInput{"UnknownCommand", "{safe_command: panic}", "unknown_value", "safe command"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
