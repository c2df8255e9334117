// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <optional>

#include "notation/document.hpp"
#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

/// The document in flow style, without quotes.
std::string flow(const Node& node) {
  std::string text;
  switch (node.kind) {
    case Node::Kind::empty:
      return "~";
    case Node::Kind::scalar:
      return node.text;
    case Node::Kind::sequence:
      for (const auto& item : node.items) text += (text.empty() ? "" : ", ") + flow(*item);
      return "[" + text + "]";
    case Node::Kind::mapping:
      for (const auto& entry : node.entries)
        text += (text.empty() ? "" : ", ") + entry.key + ": " + flow(*entry.value);
      return "{" + text + "}";
  }
  return text;
}

std::string overridden(const std::string& document, const std::string& path, const std::string& value) {
  return flow(*override_entry(parse_document(document, "f"), path, value));
}

TEST(Override, ReplacesAnEntryByItsPath) {
  EXPECT_EQ(overridden("{a: 1, b: 2}", "b", "3 kg"), "{a: 1, b: 3 kg}");
  EXPECT_EQ(overridden("{a: {b: {c: 1}}}", "a.b.c", "2"), "{a: {b: {c: 2}}}");
  EXPECT_EQ(overridden("{a: [1, 2, 3]}", "a[1]", "x"), "{a: [1, x, 3]}");
  EXPECT_EQ(overridden("{a: [{b: 1}, [2, 3]]}", "a[0].b", "4"), "{a: [{b: 4}, [2, 3]]}");
  EXPECT_EQ(overridden("{a: [[2, 3]]}", "a[0][1]", "4"), "{a: [[2, 4]]}");
}

TEST(Override, TakesAnyYamlAsValue) {
  EXPECT_EQ(overridden("{a: 1}", "a", "[0, 0.4, 0.3]"), "{a: [0, 0.4, 0.3]}");
  EXPECT_EQ(overridden("{a: 1}", "a", "{b: 2}"), "{a: {b: 2}}");
}

TEST(Override, ReadsValuesAsYamlDoes) {
  for (const char* text : {"5",       "-0.25",  "+1e-3",  ".5",      "4.9300000000000006 kg",
                           "1 N m s", "7  deg", "12 - 3", "0x10",    "-",
                           "- 1",     "1 ",     " 1",     "1: 2",    "1 # two",
                           "'1'",     "---",    "...",    "1...",    "",
                           "~",       "null",   "-.inf",  "3 m/s^2", "1, 2"}) {
    SCOPED_TRACE(text);
    std::optional<InputError> refused;
    try {
      const NodePtr read = parse_document(text, "--set a");
      const NodePtr set = override_entry(parse_document("{a: 1}", "f"), "a", text)->entries.at(0).value;
      EXPECT_EQ(set->kind, read->kind);
      EXPECT_EQ(flow(*set), flow(*read));
      EXPECT_EQ(to_string(set->place), to_string(read->place));
      EXPECT_EQ(set->pieces.size(), read->pieces.size());
    } catch (const InputError& error) {
      refused = error;
    }
    if (!refused) continue;
    const auto again = input_error([&] { override_entry(parse_document("{a: 1}", "f"), "a", text); });
    EXPECT_EQ(again->code, refused->code);
  }
}

TEST(Override, MakesWhatIsAbsent) {
  EXPECT_EQ(overridden("{a: 1}", "b.c", "2"), "{a: 1, b: {c: 2}}");
  EXPECT_EQ(overridden("{a: }", "a.b", "2"), "{a: {b: 2}}");
}

TEST(Override, AKeyMayHoldSpaces) {
  EXPECT_EQ(overridden("{s: {flat elbow: 1}}", "s.flat elbow", "2"), "{s: {flat elbow: 2}}");
}

TEST(Override, LeavesTheOriginalAndOtherAliasesAlone) {
  const NodePtr document = parse_document("{a: &x {k: 1}, b: *x}", "f");
  EXPECT_EQ(flow(*override_entry(document, "b.k", "2")), "{a: {k: 1}, b: {k: 2}}");
  EXPECT_EQ(flow(*document), "{a: {k: 1}, b: {k: 1}}");
}

TEST(Override, PlacesNameTheOption) {
  const NodePtr document = override_entry(parse_document("{a: 1}", "f"), "b.c", "30 cm");
  const Node& b = *document->entries.at(1).value;
  EXPECT_EQ(to_string(b.place), "--set b.c");
  EXPECT_EQ(to_string(b.entries.at(0).value->place), "--set b.c:1:1");
}

TEST(Override, BadPathsAreRefused) {
  const NodePtr document = parse_document("{a: [1, 2], b: 3, e: }", "f");
  std::string deep = "x";
  for (int i = 0; i < 32; ++i) deep += ".x";
  for (const std::string path :
       {"",    ".",     ".a",    "a.",    "a..b", "a[",    "a[]",  "a[x]",
        "a[0", "a[-1]", "a[0]b", "a[0].", "[0]",  "a.[0]", "a[2]", "a[18446744073709551616]",
        "a.x", "b.c",   "b[0]",  "e[0]",  "c[0]"}) {
    const auto error = input_error([&] { override_entry(document, path, "1"); });
    EXPECT_TRUE(error && error->code == "invalid_path") << path;
  }
  EXPECT_EQ(input_error([&] { override_entry(document, deep, "1"); })->code, "invalid_path");
  EXPECT_EQ(input_error([&] { override_entry(document, "\x1b[2J", "1"); })->code, "not_text");
}

TEST(Override, BadPathsSayWhatIsThere) {
  const NodePtr document = parse_document("{a: [1, 2], b: 3}", "f");
  EXPECT_STREQ(input_error([&] { override_entry(document, "a[2]", "1"); })->what(),
               "--set a[2]: no item [2] there: it is a list of 2");
  EXPECT_STREQ(input_error([&] { override_entry(document, "b.c", "1"); })->what(),
               "--set b.c: no entry 'c' there: it is '3'");
}

TEST(Override, BadValuesAreRefused) {
  const NodePtr document = parse_document("{a: 1}", "f");
  EXPECT_EQ(input_error([&] { override_entry(document, "a", ""); })->code, "empty_file");
  EXPECT_EQ(input_error([&] { override_entry(document, "a", "[1"); })->code, "invalid_yaml");
  EXPECT_EQ(input_error([&] { override_entry(document, "a", "x: y: z"); })->place.file, "--set a");
}

}  // namespace
}  // namespace mixloop
