// SPDX-License-Identifier: MIT
#include "notation/value.hpp"

#include <gtest/gtest.h>

#include <climits>

#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

NodePtr node(const std::string& text) { return parse_document(text, "f"); }

TEST(Value, NumbersComeInSi) {
  EXPECT_DOUBLE_EQ(number_of(*node("30 cm"), kLength, "the height"), 0.3);
  EXPECT_EQ(number_of(*node("0.3"), kLength, "the height"), 0.3) << "a bare number is SI";
  EXPECT_DOUBLE_EQ(number_of(*node("(1 + 2) * 10 cm"), kLength, "the height"), 0.3);
}

TEST(Value, ListsOfThem) {
  EXPECT_EQ(numbers_of(node("[1, 2 m, 300 cm]"), kLength, 3, "the point"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(numbers_of(node("4"), kLength, 1, "the point"), (std::vector<double>{4})) << "a lone one counts";
  EXPECT_EQ(numbers_of(node("[1, 2]"), kLength, 0, "the point").size(), 2U) << "any size";
}

TEST(Value, WholeNumbers) {
  EXPECT_EQ(whole_number_of(*node("12"), 1, 12, "the count"), 12);
  EXPECT_EQ(whole_number_of(*node("1e3"), 1, LONG_MAX, "the count"), 1000);
  EXPECT_EQ(whole_number_of(*node("-9007199254740992"), LONG_MIN, 0, "the count"), -9007199254740992);
}

TEST(Value, Words) { EXPECT_EQ(word_of(*node("held"), {"continuous", "held"}, "control"), 1U); }

/// What the table's rows want, by the key of their only entry.
void read(const std::string& text, const std::string& file) {
  const NodePtr root = parse_document(text, file);
  const auto& [key, place, value] = root->entries.at(0);
  if (key == "height") number_of(*value, kLength, "the height");
  if (key == "point") numbers_of(value, kLength, 3, "the point");
  if (key == "count") whole_number_of(*value, 1, LONG_MAX, "the count");
  if (key == "small") whole_number_of(*value, 1, 9, "the count");
  if (key == "control") word_of(*value, {"continuous", "held"}, "control");
}

class RefusedValue : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedValue, WithItsPlace) { expect_refused(GetParam(), read); }

INSTANTIATE_TEST_SUITE_P(
    Table, RefusedValue,
    testing::Values(
        BadInput{"Mass", "height: @5 kg", "wrong_dimension",
                 "the height is a mass (kg); expected a length (m)"},
        BadInput{"Angle", "height: @5 deg", "wrong_dimension",
                 "the height is a number or an angle; expected a length (m)"},
        BadInput{"Unit", "height: 5 @feet", "unknown_unit", "unknown unit 'feet'"},
        BadInput{"Text", "height: @tall", "undefined_symbol", "undefined symbol 'tall'; expected a number"},
        BadInput{"List", "height: @[5 m]", "wrong_kind", "found a list of 1; expected the height"},
        BadInput{"Mapping", "height: @{x: 5 m}", "wrong_kind", "found a mapping; expected the height"},
        BadInput{"Nothing", "{height: @}", "wrong_kind", "found nothing; expected the height"},
        BadInput{"LoneForThree", "point: @5 kg", "wrong_size",
                 "found '5 kg'; expected the point, a list of 3"},
        BadInput{"TwoForThree", "point: @[1, 2]", "wrong_size",
                 "found a list of 2; expected the point, a list of 3"},
        BadInput{"OneOfThreeWrong", "point: [1 m, @2 s, 3]", "wrong_dimension",
                 "the point is a time (s); expected a length (m)"},
        BadInput{"NestedLists", "point: [1, @[2], 3]", "wrong_kind", "found a list of 1; expected the point"},
        BadInput{"Fraction", "count: @1.5", "out_of_range",
                 "the count is '1.5'; expected a whole number from 1 to"},
        BadInput{"BelowTheLeast", "small: @0", "out_of_range", "expected a whole number from 1 to 9"},
        BadInput{"AboveTheMost", "small: @10", "out_of_range", "the count is '10'"},
        BadInput{"PastWhatDoublesHold", "count: @9223372036854775807", "out_of_range",
                 "the count is '9223372036854775807'"},
        BadInput{"WholeButAUnit", "count: @3 kg", "wrong_dimension", "the count is a mass (kg)"},
        BadInput{"Word", "control: @helt", "unknown_value", "control is 'helt'; did you mean 'held'?"},
        BadInput{"OtherWord", "control: @none", "unknown_value",
                 "control is 'none'; expected one of 'continuous', 'held'"}),
    bad_input_name);

}  // namespace
}  // namespace mixloop
