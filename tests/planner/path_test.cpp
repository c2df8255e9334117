// SPDX-License-Identifier: MIT
#include "planner/path.hpp"

#include <gtest/gtest.h>

#include "tests/planner/mechanisms.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

TEST(ReadPath, TakesALine) {
  const Path path = path_from(
      "{line: {from: [30 cm, 0.0, 0.8], to: [-0.3, 0.4 m, 0.3]}, duration: 900 ms, repeat: 5, approach: 2 s}",
      paper_robot());
  ASSERT_EQ(path.vias.size(), 2U);
  EXPECT_EQ(path.vias[0].point, Eigen::Vector3d(0.3, 0, 0.8));
  EXPECT_EQ(path.vias[1].point, Eigen::Vector3d(-0.3, 0.4, 0.3));
  EXPECT_EQ(path.vias[1].duration, 0.9);
  EXPECT_EQ(path.repeat, 5);
  EXPECT_EQ(path.approach, 2.0);
}

TEST(ReadPath, TakesViaPointsWithTheirOwnOrTheUsualDuration) {
  const Path path = path_from(
      "{via: [{at: [1, 0], dwell: 0.5 s}, {at: [0, 1], duration: 2 s}, {at: [0.5, 0.5]}], duration: 1 s}",
      model_from(kPlanarArm));
  ASSERT_EQ(path.vias.size(), 3U);
  EXPECT_EQ(path.vias[0].dwell, 0.5);
  EXPECT_EQ(path.vias[1].duration, 2);
  EXPECT_EQ(path.vias[2].duration, 1);
  EXPECT_EQ(path.repeat, 0);
  EXPECT_FALSE(path.approach);
}

TEST(ReadPath, PutsValuesOnTheScenesAxes) {
  const Path path = path_from("{line: {from: [1, 0.5], to: [1, 1]}, duration: 1 s}", model_from(kUprightArm));
  EXPECT_EQ(path.vias[0].point, Eigen::Vector3d(1, 0, 0.5));
}

class BadPath : public testing::TestWithParam<BadInput> {};

TEST_P(BadPath, IsRefused) {
  const auto model = paper_robot();
  expect_refused(GetParam(), [&](const std::string& text, const std::string& file) {
    read_path(parse_document(text, file), *model.scene);
  });
}

INSTANTIATE_TEST_SUITE_P(
    ReadPath, BadPath,
    testing::Values(
        BadInput{"unknown_key", "{line: {from: [0, 0, 0], to: [1, 1, 1]}, @lenght: 1 s}", "unknown_key",
                 "lenght"},
        BadInput{"no_points", "@{duration: 1 s}", "missing_key", "neither 'line' nor 'via'"},
        BadInput{"both_kinds", "@{line: {from: [0, 0, 0], to: [1, 1, 1]}, via: [], duration: 1 s}",
                 "missing_key", "both 'line' and 'via'"},
        BadInput{"no_duration", "@{line: {from: [0, 0, 0], to: [1, 1, 1]}}", "missing_key", "duration"},
        BadInput{"no_end", "{line: @{from: [0, 0, 0]}, duration: 1 s}", "missing_key", "to"},
        BadInput{"two_values", "{line: {from: @[0, 0], to: [1, 1, 1]}, duration: 1 s}", "wrong_size",
                 "a list of 3"},
        BadInput{"unit", "{line: {from: [0, @1 kg, 0], to: [1, 1, 1]}, duration: 1 s}", "wrong_dimension",
                 "kg"},
        BadInput{"no_time", "{line: {from: [0, 0, 0], to: [1, 1, 1]}, duration: @0 s}", "out_of_range",
                 "more than 0"},
        BadInput{"backwards", "{line: {from: [0, 0, 0], to: [1, 1, 1]}, duration: @-1 s}", "out_of_range",
                 "-1"},
        BadInput{"profile", "{line: {from: [0, 0, 0], to: [1, 1, 1]}, duration: 1 s, profile: @cyclodal}",
                 "unknown_value", "cycloidal"},
        BadInput{"repeat", "{line: {from: [0, 0, 0], to: [1, 1, 1]}, duration: 1 s, repeat: @1.5}",
                 "out_of_range", "whole number"},
        BadInput{"one_via", "{via: @[{at: [0, 0, 0]}]}", "wrong_size", "two or more"},
        BadInput{"via_without_duration", "{via: [{at: [0, 0, 0]}, @{at: [1, 1, 1]}]}", "missing_key",
                 "duration"},
        BadInput{"first_with_duration",
                 "{via: [{at: [0, 0, 0], duration: @1 s}, {at: [1, 1, 1], duration: 1 s}]}", "unknown_key",
                 "no line leads"},
        BadInput{"negative_dwell", "{via: [{at: [0, 0, 0], dwell: @-1 s}, {at: [1, 1, 1], duration: 1 s}]}",
                 "out_of_range", "0 or more"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
