// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

TEST(Experiments, AllHoldWhatTheyExpect) {
  std::vector<std::string> words = {bin("mixloop"), "track"};
  for (const auto& entry : std::filesystem::directory_iterator(MIXLOOP_SOURCE "/experiments"))
    words.push_back(entry.path().string());
  ASSERT_GE(words.size(), 12U);
  Command command(words);
  EXPECT_EQ(command.wait(), 0) << command.out() << command.err();
}

}  // namespace
}  // namespace mixloop
