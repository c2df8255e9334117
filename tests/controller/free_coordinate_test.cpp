// SPDX-License-Identifier: MIT
// Control laws for a mechanism of which not all coordinates have a motor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/guarded_controller.hpp"
#include "tests/support/bad_input.hpp"
#include "tests/support/crane.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

ControllerSettings settings_from(const std::string& text) {
  return read_controller_settings(parse_document(text, "controller.yaml"), *crane());
}

/// A state and what is desired of the trolley: a tenth of a metre ahead, 1 m/s faster, and to accelerate.
struct CraneBench {
  std::vector<double> psi{0, 0.5}, psid{0, 2}, row{0.1, 1, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  double tau = 0;

  CommandMarks command(const ControllerSettings& settings, double t = 0) {
    Equations::Workspace model(
        equations_of(crane(), Evaluation::interpreter, {Purpose::mass_times, Purpose::bias}), {});
    GuardedController controller(Controller(std::move(model), settings), settings.safety, settings.kv);
    return controller.torque({psi, psid, t}, reference_in(row, 1), {&tau, 1});
  }
};

TEST(ControllerOfACrane, AnswersByTheMotorsErrors) {
  CraneBench bench;
  bench.command(settings_from("{law: pd, kp: [100], kv: [10]}"));
  EXPECT_NEAR(bench.tau, 100 * 0.1 + 10 * 1, 1e-12);
}

// The motor's row of M a, the load not to accelerate, and of h: 3 a + sin(swing) swing'^2.
TEST(ControllerOfACrane, KnowsTheFreeCoordinatesAsTheyAreMeasured) {
  for (const char* at : {"measured", "desired"}) {
    CraneBench bench;
    bench.command(settings_from(std::string("{law: computed_torque, kp: [100], kv: [10], feedforward_at: ") +
                                at + "}"));
    EXPECT_NEAR(bench.tau, 20 + 3 * 4 + std::sin(0.5) * 4, 1e-12) << at;
  }
  CraneBench bench;
  bench.command(settings_from("{law: pd_gravity, kp: [100], kv: [10]}"));
  EXPECT_NEAR(bench.tau, 20, 1e-12) << "no weight is on the trolley's motor";
}

TEST(ControllerOfACrane, WatchesOverItsMotorsAlone) {
  CraneBench bench;
  EXPECT_FALSE(
      bench.command(settings_from("{law: pd, kp: [1], kv: [1], safety: {velocity_limit: [1 m/s]}}")).safe)
      << "the load swings by 2 rad/s";
  bench.psid[0] = 1.1;
  EXPECT_TRUE(
      bench.command(settings_from("{law: pd, kp: [1], kv: [1], safety: {velocity_limit: [1 m/s]}}")).safe);
}

class BadCraneController : public testing::TestWithParam<BadInput> {};

TEST_P(BadCraneController, IsRefused) {
  const auto error = input_error([] { settings_from(GetParam().text); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, GetParam().code);
  EXPECT_THAT(error->message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCraneController,
    testing::Values(BadInput{"Gains", "{law: pd, kp: [1, 1], kv: [1]}", "wrong_size", "each of the 1 motors"},
                    BadInput{"TorqueLimit", "{law: pd, kp: [1], kv: [1], safety: {torque_limit: [1, 1]}}",
                             "wrong_size", "each of the 1 motors"},
                    BadInput{"Range",
                             "{law: pd, kp: [1], kv: [1], safety: {position_range: [[0, 1], [0, 1]]}}",
                             "wrong_size", "each of the 1 motors"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
