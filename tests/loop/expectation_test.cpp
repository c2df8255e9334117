// SPDX-License-Identifier: MIT
// Expectations, limits and faults that no run can meet are refused where they stand.
#include "loop/expectation.hpp"

#include <gmock/gmock.h>

#include "loop/experiment.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

constexpr const char* kMinimal =
    "scene: " MIXLOOP_SCENES
    "/mixed_loop_robot.yaml\n"
    "path: {line: {from: [0.3, 0.0, 0.8], to: [-0.3, 0.4, 0.3]}, duration: 1 s}\n"
    "controller: {law: pd_feedforward, kp: [100, 25, 25], kv: [1.0, 0.5, 0.5]}\n";

void load_and_plan(const std::string& text, const std::string& file) {
  make_plan(load_experiment(parse_document(text, file), file, {}));
}

class Impossible : public testing::TestWithParam<BadInput> {};

TEST_P(Impossible, IsRefusedAtItsPlace) {
  BadInput row = GetParam();
  row.text = kMinimal + row.text;
  expect_refused(row, load_and_plan);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, Impossible,
    testing::Values(
        BadInput{"nothing_between", "expect: {max_position_error: @[20 mm, 10 mm]}", "out_of_range",
                 "nothing lies between"},
        BadInput{"negative_size", "expect: {rms_position_error: @-1 mm}", "out_of_range", "never below 0"},
        BadInput{"negative_least", "expect: {final_position_error: @[-1 mm, 1 mm]}", "out_of_range",
                 "never below 0"},
        BadInput{"negative_torque", "expect: {max_torque: [1, @-2, 3]}", "out_of_range", "never below 0"},
        BadInput{"not_a_number", "expect: {max_position_error: @.nan}", "not_finite", "not finite"},
        BadInput{"past_the_limit", "expect: {max_position_error: @[200 mm, 300 mm]}", "out_of_range",
                 "limits.position_error lets it be 0.1 m at most"},
        BadInput{"past_another_bound",
                 "expect: {max_position_error: 1 mm, final_position_error: @[2 mm, 3 mm]}", "out_of_range",
                 "expect.max_position_error lets it be 0.001 m at most"},
        BadInput{"not_judged", "expect: {diverges: true, max_position_error: @1 mm}", "out_of_range",
                 "no bound on max_position_error is judged"},
        BadInput{"two_ends", "expect: {diverges: true, safe_state: @true}", "out_of_range", "either"},
        BadInput{"safe_at_stages", "plant: {control: continuous}\nexpect: {safe_state: @true}",
                 "out_of_range", "control: held"},
        BadInput{"negative_velocity", "limits: {velocity: [1, @-1, 1]}", "out_of_range", "more than 0"},
        BadInput{"zero_torque", "limits: {torque: [@0, 1, 1]}", "out_of_range", "more than 0"},
        BadInput{"after_the_end", "faults: [{at: @1.5 s, motor: 1, kind: off}]", "out_of_range",
                 "after the run's end at 1 s"},
        BadInput{"just_after_the_end",
                 "faults: [{at: 0 s, motor: 1, kind: off}, {at: @1.0001 s, friction: 2}]\n"
                 "plant: {actuators: {friction: {viscous: 0.1}}}",
                 "out_of_range", "after the run's end"}),
    bad_input_name);

TEST(Expectation, MayBeMetAtItsLimits) {
  for (const char* entry :
       {"expect: {max_position_error: [0, 100 mm]}", "expect: {max_position_error: [5 mm, 5 mm]}",
        "expect: {diverges: true}", "faults: [{at: 1 s, motor: 1, kind: off}]",
        "faults: [{at: 0.2 ms, for: 0.9 ms, motor: 1, kind: off}]"})
    EXPECT_NO_THROW(load_and_plan(std::string(kMinimal) + entry, "good.yaml")) << entry;
}

}  // namespace
}  // namespace mixloop
