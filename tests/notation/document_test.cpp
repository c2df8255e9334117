// SPDX-License-Identifier: MIT
#include "notation/document.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

NodePtr parsed(const std::string& text) { return parse_document(text, "file.yaml"); }

/// Where the last character of the only scalar stands.
std::string place_of_last(const std::string& text) {
  const NodePtr root = parsed(text);
  const Node& scalar = root->kind == Node::Kind::mapping ? *root->entries.at(0).value : *root;
  const Place place = place_in(scalar, scalar.text.size() - 1);
  return fmt::format("{}:{}", place.line, place.column);
}

TEST(Document, KeepsOrderTextAndPlaces) {
  const NodePtr root = parsed("b: 30 cm\na:\n  - x\n  - {c: 'y'}\n");
  ASSERT_EQ(root->kind, Node::Kind::mapping);
  ASSERT_EQ(root->entries.size(), 2U);
  EXPECT_EQ(root->entries[0].key, "b");
  EXPECT_EQ(root->entries[0].value->text, "30 cm");
  EXPECT_EQ(to_string(root->entries[0].value->place), "file.yaml:1:4");
  EXPECT_EQ(to_string(root->entries[1].place), "file.yaml:2:1");
  const NodePtr list = root->entries[1].value;
  ASSERT_EQ(list->items.size(), 2U);
  EXPECT_EQ(to_string(list->items[1]->entries.at(0).value->place), "file.yaml:4:9");
  EXPECT_EQ(list->items[1]->entries.at(0).value->text, "y");
}

TEST(Document, AbsentNullAndTildeAreEmptyButNotAQuotedNothing) {
  const NodePtr root = parsed("a:\nb: null\nc: ~\nd: ''\n");
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(root->entries[static_cast<std::size_t>(i)].value->kind, Node::Kind::empty) << i;
  EXPECT_EQ(root->entries[3].value->kind, Node::Kind::scalar);
}

TEST(Document, AnAliasIsItsAnchorsValue) {
  const NodePtr root = parsed("a: &first {x: 1}\nb: *first\n");
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
}

TEST(Document, AByteOrderMarkAndWindowsLinesAreNoMatter) {
  const NodePtr root = parsed(
      "\xef\xbb\xbf"
      "a: 1\r\nb: 'x\r\n  y'\r\n");
  EXPECT_EQ(root->entries[0].value->text, "1");
  EXPECT_EQ(to_string(root->entries[0].value->place), "file.yaml:1:4");
  EXPECT_EQ(to_string(root->entries[1].place), "file.yaml:2:1");
  EXPECT_EQ(root->entries[1].value->text, "x y");
}

TEST(Document, EveryCharacterOfAScalarHasItsPlace) {
  EXPECT_EQ(place_of_last("a: 1 + 2"), "1:8");
  EXPECT_EQ(place_of_last("a: '1 + 2'"), "1:9") << "past the quote";
  EXPECT_EQ(place_of_last("a: \"1 + 2\""), "1:9");
  EXPECT_EQ(place_of_last("a: &x 1 + 2"), "1:11") << "past the anchor";
  EXPECT_EQ(place_of_last("a: !t 1 + 2"), "1:11") << "past the tag";
  EXPECT_EQ(place_of_last("a: 1 +\n  2"), "2:3") << "on the next line";
  EXPECT_EQ(place_of_last("a: '1 +\n\n   2'"), "3:4");
  EXPECT_EQ(place_of_last("a: |\n  1 +\n    2\n"), "3:6") << "its line break";
  EXPECT_EQ(place_of_last("a: >-  # folded\n  1 +\n  2"), "3:3");
  EXPECT_EQ(place_of_last("a:\n   \"1 +\r\n   2\""), "3:4");
}

TEST(Document, AfterAnEscapePlacesCountFromTheLastKnownOne) {
  EXPECT_EQ(place_of_last("a: \"1\\x20+ 2\""), "1:9");
}

TEST(Document, ThirtyTwoLevelsAreRead) {
  std::string text = "1";
  for (int i = 0; i < 15; ++i) text = i % 2 == 0 ? "{a: " + text + "}" : "[" + text + "]";
  EXPECT_NO_THROW(parsed(text));
  const NodePtr deep = parsed([] {
    std::string lines;
    for (int i = 0; i < 32; ++i) lines += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    return lines;
  }());
  EXPECT_EQ(deep->kind, Node::Kind::mapping);
}

TEST(Document, SaysWhatItIs) {
  EXPECT_EQ(describe(*parsed("abc")), "'abc'");
  EXPECT_EQ(describe(*parsed("[1, 2]")), "a list of 2");
  EXPECT_EQ(describe(*parsed("{a: 1}")), "a mapping");
  EXPECT_EQ(describe(*parsed("[~]")->items[0]), "nothing");
  EXPECT_EQ(describe(*parsed(std::string(100, 'x'))).size(), 65U);
}

TEST(Document, MappingFindsItsKeys) {
  const Mapping mapping(parsed("{a: 1}"), "a thing", {"a", "b"});
  EXPECT_TRUE(mapping.has("a"));
  EXPECT_FALSE(mapping.has("b"));
  EXPECT_EQ(mapping.at("a")->text, "1");
  const auto error = input_error([&] { mapping.at("b"); });
  EXPECT_EQ(error->code, "missing_key");
  EXPECT_STREQ(error->what(), "file.yaml:1:1: a thing lacks the key 'b'");
}

TEST(Document, ALoneValueCountsAsAListOfOne) {
  EXPECT_EQ(items_of(parsed("x"), "names").size(), 1U);
  EXPECT_EQ(items_of(parsed("[]"), "names").size(), 0U);
  EXPECT_EQ(input_error([] { items_of(parsed("{a: 1}"), "names"); })->message,
            "found a mapping; expected a list: names");
}

TEST(Document, FlagsAreSaidInAFewWays) {
  EXPECT_TRUE(flag_of(*parsed("true"), "x"));
  EXPECT_TRUE(flag_of(*parsed("on"), "x"));
  EXPECT_FALSE(flag_of(*parsed("no"), "x"));
  EXPECT_EQ(input_error([] { flag_of(*parsed("maybe"), "x"); })->message,
            "found 'maybe'; expected true or false for x");
}

TEST(Document, LimitsAreReachedInLinearTime) {  // ctest's time limit is the judge
  std::string keys, items = "- &a [1, 2]\n";
  for (int i = 0; i < 49'000; ++i) keys += fmt::format("k{}: 1\n", i);
  for (int i = 0; i < 33'000; ++i) items += "- *a\n";
  EXPECT_EQ(parsed(keys)->entries.size(), 49'000U);
  EXPECT_EQ(parsed(items)->items.size(), 33'001U);
}

class RefusedDocument : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedDocument, WithItsPlace) {
  expect_refused(GetParam(),
                 [](const std::string& text, const std::string& file) { parse_document(text, file); });
}

std::string repeated(const std::string& part, std::size_t size) {
  std::string text;
  while (text.size() < size) text += part;
  return text;
}

/// Each anchor a list of ten of the one before: 10^9 values in 200 bytes.
std::string billion_laughs() {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    text += fmt::format("a{}: &a{} [", i, i);
    for (int k = 0; k < 10; ++k)
      text += fmt::format("{}{}*a{}", k ? ", " : "", i == 4 && k == 9 ? "@" : "", i - 1);
    text += "]\n";
  }
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, RefusedDocument,
    testing::Values(
        BadInput{"Empty", "", "empty_file", "found nothing"},
        BadInput{"OnlyComments", "# nothing\n\n# here\n", "empty_file", "found nothing"},
        BadInput{"OnlyNull", "~\n", "empty_file", "found nothing"},
        BadInput{"SecondDocument", "a: 1\n---\n@b: 2\n", "invalid_yaml", "second document"},
        BadInput{"Unbalanced", "a: [1, 2\n@", "invalid_yaml", "no valid YAML"},
        BadInput{"Tab", "a:\n\tb@: 1\n", "invalid_yaml", "no valid YAML"},
        BadInput{"TabExplained", "a:\n\tb@: 1\n", "invalid_yaml",
                 "the line begins with a tab; expected spaces"},
        BadInput{"NoBreakSpaceBehindAColon", "rate:\u00a01\npath@: {a: 1}\n", "invalid_yaml",
                 "a no-break space (U+00A0)"},
        BadInput{"DecimalCommaInBraces", "{mass: 0,@5 kg, frame: x}", "invalid_yaml",
                 "for 0,5 kg write 0.5 kg"},
        BadInput{"DecimalCommasInBraces", "{x: -1,@5, y: 1,5}", "invalid_yaml", "for -1,5 write -1.5"},
        BadInput{"ColonInValue", "a: b@: c\n", "invalid_yaml", "no valid YAML"},
        BadInput{"UnknownAlias", "a: @*b\n", "invalid_yaml", "anchor"},
        BadInput{"AliasOfItself", "a: &a [1, @*a]\n", "invalid_yaml", "contains it"},
        BadInput{"KeyTwice", "a: 1\nb: 2\n@a: 3\n", "doubly_defined", "'a' is given twice, first at line 1"},
        BadInput{"KeyTwiceInFlow", "x: {a: 1, @a: 3}\n", "doubly_defined", "'a' is given twice"},
        BadInput{"KeyIsAList", "? @[1]\n: 2\n", "wrong_kind", "a key is a list of 1; expected a name"},
        BadInput{"KeyIsNothing", "@~: 2\n", "wrong_kind", "a key is nothing; expected a name"},
        BadInput{"Nul", std::string("a: 1\nb: @\0\n", 11), "not_text", "the byte 0x00"},
        BadInput{"Escape", "a: 1\nb: @\x1b[31m\n", "not_text", "the byte 0x1b"},
        BadInput{"Latin1", "a: K@\xf6ln\n", "not_text", "the byte 0xf6"},
        BadInput{"Utf16",
                 "@\xff\xfe"
                 "a",
                 "not_text", "the byte 0xff"},
        BadInput{"Elf",
                 "@\x7f"
                 "ELF\x02\x01\x01",
                 "not_text", "the byte 0x7f"},
        BadInput{"EscapedControl", "a: @\"\\e[31m\"\n", "not_text", "control character"},
        BadInput{"EscapedControlInKey", "@\"\\0\": 1\n", "not_text", "control character"},
        BadInput{"TooDeepInFlow", repeated("{a: ", 128) + "@[1]" + std::string(32, '}'), "too_deep",
                 "deeper than 32 levels"},
        BadInput{"TooDeepInBlocks", repeated("- ", 64) + "@- 1", "too_deep", "deeper than 32 levels"},
        BadInput{"BillionLaughs", billion_laughs(), "too_large", "more than 100000 values"},
        BadInput{"TooManyValues", repeated("- 1\n", 400'000 - 4) + "- @1\n", "too_large",
                 "more than 100000 values"},
        BadInput{"TooManyBytes", repeated("# a comment\n", (1 << 20) + 1), "too_large",
                 "larger than 1048576 bytes"}),
    bad_input_name);

class RefusedKey : public testing::TestWithParam<BadInput> {};

TEST_P(RefusedKey, WithTheNearestKnownOne) {
  expect_refused(GetParam(), [](const std::string& text, const std::string& file) {
    Mapping(parse_document(text, file), "a body", {"frame", "mass"});
  });
}

INSTANTIATE_TEST_SUITE_P(
    Table, RefusedKey,
    testing::Values(BadInput{"Near", "frame: 1\n@mas: 2\n", "unknown_key",
                             "unknown key 'mas' in a body; did you mean 'mass'?"},
                    BadInput{"Far", "@colour: red\n", "unknown_key",
                             "unknown key 'colour' in a body; expected one of 'frame', 'mass'"},
                    BadInput{"NoBreakSpace", "@mass\u00a0: 1\n", "unknown_key", "a no-break space (U+00A0)"},
                    BadInput{"Long", "@" + std::string(500, 'k') + ": 1\n", "unknown_key", "...' in a body"},
                    BadInput{"NoMapping", "@[1]\n", "wrong_kind",
                             "found a list of 1; expected a body as a mapping"}),
    bad_input_name);

/// A file that is gone when the test ends.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / fmt::format("mixloop-{}.yaml", ::getpid())) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(DocumentFile, IsReadWithItsNameInPlaces) {
  const File file("a: 1\n");
  EXPECT_EQ(to_string(read_document(file.path())->place), file.path().string() + ":1:1");
}

TEST(DocumentFile, OfAHundredMegabytesIsRefusedUnread) {
  const File file("");
  std::filesystem::resize_file(file.path(), 100'000'000);
  const auto error = input_error([&] { read_document(file.path()); });
  EXPECT_EQ(error->code, "too_large");
  EXPECT_EQ(error->place.file, file.path().string());
}

TEST(DocumentFile, ThatIsNoneIsNamed) {
  for (const char* path : {"/nowhere/scene.yaml", "/", ""}) {
    const auto error = input_error([&] { read_document(path); });
    EXPECT_EQ(error->code, "no_such_file") << path;
    EXPECT_EQ(error->place.file, path);
  }
}

}  // namespace
}  // namespace mixloop
