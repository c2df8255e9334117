// SPDX-License-Identifier: MIT
#include "notation/number_text.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

TEST(NumberText, HasItsDigitsAndNeverHundredsOfThem) {
  EXPECT_EQ(fixed(13.20669364, 7), "13.2066936");
  EXPECT_EQ(fixed(-0.5, 1), "-0.5");
  EXPECT_EQ(fixed(123456789.25, 1), "123456789.2");
  EXPECT_EQ(fixed(1e300, 7), "1e+300");
  EXPECT_EQ(fixed(-1.23456789e12, 3), "-1.23e+12");
}

}  // namespace
}  // namespace mixloop
