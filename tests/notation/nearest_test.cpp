// SPDX-License-Identifier: MIT
#include "notation/nearest.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace mixloop {
namespace {

const std::vector<std::string> kKeys = {"name", "frame", "mass", "center_of_mass", "inertia"};

TEST(Nearest, FindsTheWordBehindASlip) {
  EXPECT_EQ(nearest("fram", kKeys), "frame") << "a letter missing";
  EXPECT_EQ(nearest("masss", kKeys), "mass") << "one too many";
  EXPECT_EQ(nearest("nane", kKeys), "name") << "a wrong one";
  EXPECT_EQ(nearest("nmae", kKeys), "name") << "two swapped";
  EXPECT_EQ(nearest("Mass", kKeys), "mass") << "another case";
  EXPECT_EQ(nearest("INERTIA", kKeys), "inertia");
  EXPECT_EQ(nearest("centre_of_mass", kKeys), "center_of_mass");
}

TEST(Nearest, FindsNothingWhereNothingIsNear) {
  EXPECT_EQ(nearest("colour", kKeys), "");
  EXPECT_EQ(nearest("mass", {}), "");
  EXPECT_EQ(nearest("3", std::vector<std::string>{"0", "1"}), "") << "one edit away, but nothing in common";
  EXPECT_EQ(nearest(std::string(65, 'm'), kKeys), "") << "no word is that long";
}

TEST(Nearest, OfTwoEquallyNearTheFirst) {
  EXPECT_EQ(nearest("q", std::vector<std::string>{"q1", "q2"}), "q1");
}

TEST(Suggestion, NamesTheNearestOrAll) {
  EXPECT_EQ(suggestion("fram", kKeys), "; did you mean 'frame'?");
  EXPECT_EQ(suggestion("colour", std::vector<std::string>{"x", "y"}), "; expected one of 'x', 'y'");
  EXPECT_EQ(suggestion("colour", std::vector<std::string>{"rk4"}), "; expected 'rk4'");
  EXPECT_EQ(suggestion("colour", {}), "; none is known here");
}

TEST(Suggestion, StaysShort) {
  std::vector<std::string> many(1000, std::string(1000, 'x'));
  EXPECT_LT(suggestion("colour", many).size(), 2000U);
  EXPECT_NE(suggestion("colour", many).find("(1000 in all)"), std::string::npos);
}

}  // namespace
}  // namespace mixloop
