// SPDX-License-Identifier: MIT
#include "notation/dimension.hpp"

#include <gtest/gtest.h>

#include "notation/unit.hpp"

namespace mixloop {
namespace {

TEST(Dimension, ProductsAddPowers) {
  EXPECT_TRUE((kForce * kLength).same_powers(kMoment));
  EXPECT_TRUE((kMoment / (kMass * kLength * kLength)).same_powers(power(kFrequency, 2)));
  EXPECT_TRUE(power(kLength, -2).same_powers(kPure / kLength / kLength));
}

TEST(Dimension, ABareNumberTakesItsPartnersDimensionInASum) {
  EXPECT_TRUE(sum_dimension(kOpen, kLength)->same_powers(kLength));
  EXPECT_TRUE(sum_dimension(kLength, kOpen)->same_powers(kLength));
  EXPECT_FALSE(sum_dimension(kLength, kPure));
  EXPECT_FALSE(sum_dimension(kLength, kMass));
}

TEST(Dimension, ABareNumberFitsAnywhereAnAngleDoesNot) {
  EXPECT_TRUE(fits(kOpen, kMass));
  EXPECT_TRUE(fits(kMass, kOpen));
  EXPECT_FALSE(fits(kPure, kMass));
  EXPECT_TRUE((kOpen * kOpen).open);
  EXPECT_FALSE((kOpen * kPure).open) << "an angle among the factors closes it";
}

TEST(Dimension, SaysItselfInWordsOrUnits) {
  EXPECT_EQ(to_string(kLength), "a length (m)");
  EXPECT_EQ(to_string(kOpen), "a number or an angle");
  EXPECT_EQ(to_string(kMass * kLength), "kg m");
  EXPECT_EQ(to_string(power(kLength, -3)), "m^-3");
  EXPECT_EQ(to_string(Dimension{1, 0, 0, false}), "m^(1/2)");
}

TEST(Unit, KnowsWhatOneIsInSi) {
  EXPECT_EQ(find_unit("cm")->factor, 0.01);
  EXPECT_TRUE(find_unit("Nm")->dimension.same_powers(find_unit("J")->dimension));
  EXPECT_DOUBLE_EQ(find_unit("rpm")->factor * 60, find_unit("rev")->factor);
  EXPECT_FALSE(find_unit("inch"));
  EXPECT_FALSE(find_unit(""));
  for (const auto& name : unit_names()) EXPECT_TRUE(find_unit(name)) << name;
}

}  // namespace
}  // namespace mixloop
