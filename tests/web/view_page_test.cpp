// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

// web/test/view.mjs says what is looked at.
TEST(ViewPage, FollowsThePlantInABrowserAndAgreesWithTheBus) {
  ScratchFolder folder;
  Command look({MIXLOOP_NODE, std::string(MIXLOOP_WEB_TESTS) + "/view.mjs", MIXLOOP_CHROMIUM, bin("mixloop"),
                experiment("paper"), folder.path().string()});
  EXPECT_EQ(look.wait(std::chrono::seconds(280)), 0) << look.out() << look.err();
  RecordProperty("rates", look.out());
}

}  // namespace
}  // namespace mixloop
