// SPDX-License-Identifier: MIT
// Closures that can't be: each told with its place, what was found and what was expected.
#include <gtest/gtest.h>

#include "tests/dynamics/assembly/closed_scenes.hpp"

namespace mixloop {
namespace {

struct Refusal {
  const char* what;
  std::string text;
  std::string code, message;
};

std::string closing(const std::string& closures) {
  return with(four_bar(), "  - {name: loop, coincide: [{frame: coupler}, {frame: rocker}]}", closures);
}

const std::vector<Refusal>& refusals() {
  static const std::vector<Refusal> all = {
      {"too few rows", closing("  - {coincide: [{frame: coupler}, {frame: rocker}], axes: [x]}"),
       "underconstrained", "determine 1 of 2 coordinates"},
      {"rows that contradict",
       closing("  - {name: loop, coincide: [{frame: coupler}, {frame: rocker}]}\n"
               "  - {name: fixed, zero: q3 - 10 deg}"),
       "overconstrained", "stay open"},
      {"a motor that can't move",
       closing("  - {name: loop, coincide: [{frame: coupler}, {frame: rocker}]}\n"
               "  - {name: fixed, zero: crank - 60 deg}"),
       "overconstrained", "'fixed'"},
      {"lengths that don't reach", with(four_bar(), "b: 0.9 m", "b: 0.05 m"), "cannot_assemble",
       "'loop' (by "},
      {"two ways as near", four_bar("crank: 60 deg, q2: -77.0 deg, q3: 162.7 deg"), "ambiguous_branch",
       "about as near"},
      {"flat at home", with(four_bar("crank: 0 deg, q2: 0 deg, q3: 0 deg"), "c: 0.8 m", "c: 0.2 m"),
       "singular_home", "can move there while the motors stand"},
      {"within one body", closing("  - {coincide: [{frame: pivot}, {frame: 0}]}"), "within_one_body",
       "nothing moves against each other"},
      {"a motor that moves nothing", with(four_bar(), "motors: [crank]", "motors: [crank, idle]"),
       "moves_nothing", "'idle' moves nothing"},
      {"a guess beside a formula", four_bar("crank: 60 deg, q1: 60 deg"), "guess_beside_formula",
       "follows from its formula"},
      {"a distance of nothing", closing("  - {distance: 0 m, between: [{frame: coupler}, {frame: rocker}]}"),
       "out_of_range", "'coincide'"},
      {"no kind", closing("  - {name: loop, between: [{frame: coupler}, {frame: rocker}]}"), "missing_key",
       "one of coincide, distance, parallel, align and zero"},
      {"two kinds", closing("  - {zero: q2, align: [coupler, rocker]}"), "wrong_kind", "both align and zero"},
      {"one point", closing("  - {coincide: [{frame: coupler}]}"), "wrong_size", "two points"},
      {"an unknown frame", closing("  - {coincide: [{frame: coupler}, {frame: rockr}]}"), "broken_path",
       "rocker"},
      {"an axis of no length",
       closing("  - {parallel: [{frame: coupler, axis: [0, 0, 0]}, {frame: rocker, axis: z}]}"),
       "out_of_range", "length 0"},
      {"an axis twice", closing("  - {coincide: [{frame: coupler}, {frame: rocker}], axes: [x, x]}"),
       "doubly_defined", "'x'"},
      {"what is zero is a mass", closing("  - {zero: 2 kg}"), "wrong_dimension", "an angle or a length"},
      {"an unknown key", closing("  - {zero: q2, of: q3}"), "unknown_key", "of"},
      {"the same name", closing("  - {name: a, zero: q2}\n  - {name: a, zero: q3}"), "doubly_defined", "'a'"},
      {"nothing says what a coordinate is", with(four_bar(), "[q1, q2, q3]", "[q1, q2, q3, q4]"),
       "missing_constraint", "{q4: rotary}"},
  };
  return all;
}

TEST(Closures, RefusesWhatCannotBe) {
  for (const Refusal& refusal : refusals()) {
    try {
      loaded(refusal.text);
      ADD_FAILURE() << refusal.what << ": accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.code, refusal.code) << refusal.what << ": " << error.what();
      EXPECT_NE(error.message.find(refusal.message), std::string::npos)
          << refusal.what << ": " << error.message;
      EXPECT_GT(error.place.line, 0) << refusal.what;
    }
  }
}

}  // namespace
}  // namespace mixloop
