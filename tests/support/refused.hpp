// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {

/// Holds that `mixloop WORDS... --json` ends with this status and says so: the error's code, and a part of
/// its message.
inline void expect_refused(std::vector<std::string> words, int status, const std::string& code,
                           const std::string& message) {
  words.insert(words.begin(), bin("mixloop"));
  words.emplace_back("--json");
  Command command(words);
  EXPECT_EQ(command.wait(), status) << command.out();
  EXPECT_EQ(command.json()["error"]["code"], code) << command.out();
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), testing::HasSubstr(message));
}

}  // namespace mixloop
