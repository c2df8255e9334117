// SPDX-License-Identifier: MIT
// What a person writes of an entry that is varied.
#include <gmock/gmock.h>

#include "sweep/design.hpp"
#include "sweep/request.hpp"
#include "tests/support/command.hpp"
#include "tests/sweep/refused_with.hpp"

namespace mixloop {
namespace {

using testing::ElementsAre;

TEST(Variation, ARangeHasItsEndsAndIsEven) {
  const Variation range = parse_varied("a.b[0]=0..1 kg:11");
  EXPECT_EQ(range.key, "a.b[0]");
  EXPECT_EQ(range.unit, "kg");
  ASSERT_EQ(range.size(), 11);
  EXPECT_EQ(range.text_of(range.numbers[3]), "0.3 kg");
  EXPECT_EQ(range.numbers.back(), 1);
  EXPECT_THAT(parse_varied("a=20 N m/rad..-10 N m/rad:2").numbers, ElementsAre(20, -10));
  EXPECT_EQ(parse_varied("a=20..10 N m/rad:2").unit, "N m/rad");
}

TEST(Variation, AListHasNumbersOfOneUnitOrTexts) {
  EXPECT_THAT(parse_varied("a=0, 2,5 kg").numbers, ElementsAre(0, 2, 5));
  EXPECT_THAT(parse_varied("a=stuck,off").texts, ElementsAre("stuck", "off"));
  EXPECT_THAT(parse_varied("a=1 m,50 cm").texts, ElementsAre("1 m", "50 cm"));
  EXPECT_THAT(parse_varied("a=[1, 2],[3,4]").texts, ElementsAre("[1, 2]", "[3,4]"));
}

TEST(Variation, WhatCannotBeIsRefusedWithTheWayOut) {
  const auto refused = [](const char* text, const char* code, const char* message) {
    SCOPED_TRACE(text);
    expect_refused_with(code, message, [&] { parse_varied(text); });
  };
  refused("a=1..2", "invalid_range", "how many");
  refused("a=1..2:x", "invalid_range", "from..to:count");
  refused("a=1..2:0", "out_of_range", "expected 1 to");
  refused("a=1..1:3", "out_of_range", "an empty range");
  refused("a=1..2:1", "out_of_range", "two values or more");
  refused("a=1 m..2 kg:3", "invalid_range", "one unit");
  refused("a=1,,2", "wrong_size", "between two commas");
  refused("a=1..2 kgg:3", "unknown_unit", "did you mean 'kg'");
  refused("a", "invalid_override", "key=");
  expect_refused_with("unknown_value", "did you mean 'normal'", [] { parse_sampled("a=norml(1, 2)"); });
  expect_refused_with("unknown_value", "nothing to sample from", [] { parse_sampled("a="); });
  expect_refused_with("invalid_range", "normal(mean, std)", [] { parse_sampled("a=normal(1)"); });
  expect_refused_with("out_of_range", "more than 0", [] { parse_sampled("a=normal(1, 0)"); });
  expect_refused_with("out_of_range", "empty range", [] { parse_sampled("a=uniform(2, 1)"); });
}

TEST(Variation, AllCombinationsComeTheLastEntryFirst) {
  const Design design({.varied = {parse_varied("a=1,2"), parse_varied("b=x,y,z")}});
  ASSERT_EQ(design.runs(), 6);
  const auto overrides = design.overrides(4);
  EXPECT_EQ(overrides[0].value, "2");
  EXPECT_EQ(overrides[1].value, "y");
  expect_refused_with("doubly_defined", "'a' is varied already", [] {
    Design({.varied = {parse_varied("a.b=1,2"), parse_varied("a=1,2")}});
  });
  expect_refused_with("missing_key", "nothing is varied", [] { Design({}); });
}

TEST(Variation, AFileIsReadWithItsPlaces) {
  const ScratchFolder folder;
  folder.write("base.yaml", "scene: x\n");
  const std::string head = "experiment: base.yaml\n";
  const SweepRequest request =
      read_sweep(folder.write("a.sweep.yaml", head + R"yaml(set: {controller.kp: [1, 2, 3]}
vary: {a: "0..5 kg:6", b: [off, stuck], c: [[1, 2], [3, 4]]}
sample: {d: "normal(1 m, 0.1 m)"}
runs: 12
design: sobol
seed: 5
settled_within: 2 mm
expect: [{share: 0.99, max_position_error: 14 mm}]
)yaml"));
  EXPECT_EQ(request.design.draws, 12);
  EXPECT_EQ(request.design.spread, Spread::sobol);
  EXPECT_EQ(request.design.seed, 5U);
  EXPECT_EQ(request.settled_within, 0.002);
  ASSERT_EQ(request.expect.size(), 1U);
  EXPECT_EQ(request.expect[0].share, 0.99);
  EXPECT_THAT(request.design.varied[2].texts, ElementsAre(R"(["1","2"])", R"(["3","4"])"));
  EXPECT_EQ(request.overrides.at(0).value, R"(["1","2","3"])");
  expect_refused_with("invalid_range", "how many",
                      [&] { read_sweep(folder.write("b.yaml", head + "vary: {a: 1..2}\n")); });
  expect_refused_with("unknown_key", "did you mean 'vary'",
                      [&] { read_sweep(folder.write("b.yaml", head + "vari: {}\n")); });
  expect_refused_with("no_such_file", "no experiment at 'none.yaml'",
                      [&] { read_sweep(folder.write("b.yaml", "experiment: none.yaml\n")); });
  expect_refused_with("out_of_range", "1 at most",
                      [&] { read_sweep(folder.write("b.yaml", head + "expect: [{share: 2}]\n")); });
}

}  // namespace
}  // namespace mixloop
