// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "notation/errors.hpp"

namespace mixloop {

/// One row of a table of bad inputs. An `@` in `text` marks where the error must be found, and is taken
/// out before the text is read; without one the error concerns the file as a whole.
struct BadInput {
  const char* name;
  std::string text;
  const char* code;
  const char* message;  ///< a part of it

  friend std::ostream& operator<<(std::ostream& out, const BadInput& bad) { return out << bad.name; }
};

inline std::string bad_input_name(const testing::TestParamInfo<BadInput>& info) { return info.param.name; }

/// The text without its mark, and the mark's place.
inline std::pair<std::string, Place> unmarked(std::string text, const std::string& file) {
  const auto mark = text.find('@');
  if (mark == std::string::npos) return {text, {file}};
  text.erase(mark, 1);
  Place place{file, 1, 1};
  for (std::size_t i = 0; i < mark; ++i) {
    ++place.column;
    if (text[i] == '\n') ++place.line, place.column = 1;
  }
  return {text, place};
}

/// The InputError that `action` throws; fails when it throws none.
inline std::optional<InputError> input_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "no InputError";
  return std::nullopt;
}

/// Reads the row's text with `read(text, file)` and holds the error against the row.
inline void expect_refused(const BadInput& bad,
                           const std::function<void(const std::string&, const std::string&)>& read) {
  const auto [text, place] = unmarked(bad.text, "bad.yaml");
  SCOPED_TRACE(text.substr(0, 2000));
  const auto error = input_error([&, &plain = text] { read(plain, "bad.yaml"); });
  if (!error) return;
  EXPECT_EQ(error->code, bad.code);
  EXPECT_EQ(to_string(error->place), to_string(place));
  EXPECT_NE(std::string(error->what()).find(bad.message), std::string::npos) << error->what();
  EXPECT_EQ(std::string(error->what()).find(to_string(place) + ": "), 0U) << error->what();
}

}  // namespace mixloop
