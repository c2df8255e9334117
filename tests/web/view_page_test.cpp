// SPDX-License-Identifier: MIT
#include "tests/web/look.hpp"

namespace mixloop {
namespace {

TEST(ViewPage, FollowsThePlantInABrowserAndAgreesWithTheBus) {
  const ScratchFolder folder;
  RecordProperty("rates", look("view.mjs", {bin("mixloop"), experiment("paper"), folder.path().string()}));
}

}  // namespace
}  // namespace mixloop
