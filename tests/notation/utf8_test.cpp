// SPDX-License-Identifier: MIT
#include "notation/utf8.hpp"

#include <gtest/gtest.h>

namespace mixloop {
namespace {

TEST(Utf8, TextOfAnyScriptIsText) {
  EXPECT_FALSE(first_non_text(""));
  EXPECT_FALSE(first_non_text("tab\tline\r\n"));
  EXPECT_FALSE(first_non_text("\u00a0\u03c8\u2081 \u20ac \U0001f916 \U0010ffff"));
}

TEST(Utf8, FindsTheFirstByteThatIsNoText) {
  EXPECT_EQ(first_non_text(std::string_view("ab\0c", 4)), 2U);
  EXPECT_EQ(first_non_text("a\x1b[2J"), 1U);
  EXPECT_EQ(first_non_text("\x7f"), 0U);
  EXPECT_EQ(first_non_text("\u03c8\u009b"), 2U) << "a control character of two bytes";
}

TEST(Utf8, RefusesWhatUtf8Forbids) {
  EXPECT_EQ(first_non_text("a\x80"), 1U) << "a continuation without its lead";
  EXPECT_EQ(first_non_text("a\xcf"), 1U) << "cut at the end";
  EXPECT_EQ(first_non_text("a\xe2\x82"), 1U) << "cut at the end";
  EXPECT_EQ(first_non_text("a\xe2\x28\xa1"), 1U) << "no continuation";
  EXPECT_EQ(first_non_text("\xc0\xaf"), 0U) << "two bytes for what one can say";
  EXPECT_EQ(first_non_text("\xe0\x80\xaf"), 0U);
  EXPECT_EQ(first_non_text("\xf0\x80\x80\xaf"), 0U);
  EXPECT_EQ(first_non_text("\xed\xa0\x80"), 0U) << "a surrogate";
  EXPECT_EQ(first_non_text("\xf4\x90\x80\x80"), 0U) << "past the last character";
  EXPECT_EQ(first_non_text("\xff\xfe"), 0U);
}

TEST(Utf8, QuotesAreCutBetweenCharacters) {
  EXPECT_EQ(in_quotes("abc", 3), "'abc'");
  EXPECT_EQ(in_quotes("abcd", 3), "'abc...'");
  EXPECT_EQ(in_quotes("a\nb\tc"), "'a b c'") << "on one line";
  EXPECT_EQ(in_quotes("ab\u20acd", 3), "'ab...'");
  EXPECT_EQ(in_quotes("ab\u20acd", 4), "'ab...'");
  EXPECT_EQ(in_quotes("ab\u20acd", 5), "'ab\u20ac...'");
}

TEST(Utf8, PrintableTextHasNothingThatATerminalObeys) {
  EXPECT_EQ(printable("\u03c8 is\n\tfine"), "\u03c8 is\n\tfine");
  EXPECT_EQ(printable("red\x1b[31m\r\x7f"), "red\\x1b[31m\\x0d\\x7f");
  EXPECT_EQ(printable("a\u009b"
                      "2J"),
            "a\\xc2\\x9b"
            "2J")
      << "a control character of two bytes";
  EXPECT_EQ(printable("\xff\xe2\x82"), "\\xff\\xe2\\x82") << "no UTF-8";
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable_name("two\nlines\t"), "two\\x0alines\\x09");
  EXPECT_EQ(in_quotes("\x1b[2J"), "'\\x1b[2J'");
}

}  // namespace
}  // namespace mixloop
