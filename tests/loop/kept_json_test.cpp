// SPDX-License-Identifier: MIT
#include "loop/kept_json.hpp"

#include <gmock/gmock.h>

#include "tests/support/bad_input.hpp"

namespace mixloop {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

TEST(KeptJson, GivesWhatIsThereAndElseWhatStandsForIt) {
  const auto json = ordered_json::parse(R"({"rate": 500, "name": "a", "by": {"x": 1, "y": 2}, "list": [1]})");
  const KeptJson kept(json, "result.json");
  EXPECT_EQ(kept.value<double>("rate"), 500);
  EXPECT_EQ(kept.value<std::int64_t>("rate"), 500);
  EXPECT_EQ(kept.value<std::string>("name", "b"), "a");
  EXPECT_EQ(kept.value<std::string>("other", "b"), "b");
  EXPECT_EQ((kept.value<std::map<std::string, double>>("by").at("y")), 2);
  EXPECT_EQ(kept.value<std::vector<double>>("list"), std::vector<double>{1});
}

/// Of an entry that is something else: the error that asking for a T throws.
template <class T>
std::string refusal(const std::string& text) {
  const ordered_json json = {{"entry", ordered_json::parse(text)}};
  const auto error = input_error([&] { KeptJson(json, "kept/result.json").value<T>("entry", {}); });
  if (!error) return "";
  EXPECT_EQ(error->code, "wrong_kind");
  return error->what();
}

TEST(KeptJson, SaysWhatItFoundWhereAndWhatItExpected) {
  EXPECT_EQ(refusal<double>(R"("fast")"),
            R"(kept/result.json: its 'entry' is '"fast"'; expected a number, as --out keeps it)");
  EXPECT_THAT(refusal<double>("null"), HasSubstr("'null'; expected a number"));
  EXPECT_THAT(refusal<std::int64_t>("1.5"), HasSubstr("'1.5'; expected a whole number"));
  EXPECT_THAT(refusal<std::string>("[1]"), HasSubstr("'[1]'; expected a text"));
  EXPECT_THAT(refusal<std::vector<std::string>>("[1]"),
              HasSubstr("'[1]'; expected a list, each of it a text"));
  EXPECT_THAT((refusal<std::map<std::string, double>>(R"({"x": "y"})")),
              HasSubstr("expected a group of entries, each a number"));
  const ordered_json empty = ordered_json::object();
  const auto missing = input_error([&] { KeptJson(empty, "inputs.json").value<double>("rate"); });
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->code, "missing_key");
}

}  // namespace
}  // namespace mixloop
