// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {

/// Holds that a script of web/test, which says what it looks at, is content with what the browser shows; what
/// it prints.
inline std::string look(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {MIXLOOP_NODE, MIXLOOP_WEB_TESTS "/" + script, MIXLOOP_CHROMIUM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Command command(words);
  EXPECT_EQ(command.wait(std::chrono::seconds(280)), 0) << command.out() << command.err();
  return command.out();
}

}  // namespace mixloop
