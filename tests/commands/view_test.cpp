// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/refused.hpp"

namespace mixloop {
namespace {

TEST(View, RefusesWhatItCannotShow) {
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  expect_refused({"view", folder.file("nothing")}, 2, "cannot_read", "no such file");
  expect_refused({"view", folder.write("text", "hello, log")}, 2, "not_a_log", "LCM event log");
  expect_refused({"view", experiment("paper"), "--experiment", experiment("paper")}, 2, "command_line",
                 "is named already");
  const std::string out = folder.file("kept");
  Command simulate({bin("mixloop"), "simulate", experiment("paper"), "--json", "--out", out});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  std::filesystem::remove(out + "/inputs.json");
  expect_refused({"view", out}, 2, "no_scene", "--experiment FILE");
}

TEST(View, ServesUntilItIsStopped) {
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  Command view({bin("mixloop"), "view", experiment("paper"), "--port", "0", "--json"});
  ASSERT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
  const std::string url = view.json()["url"];
  EXPECT_THAT(url, testing::StartsWith("http://127.0.0.1:"));
  // Another one finds the port taken, and says what to do.
  const std::string port = url.substr(17, url.size() - 18);
  expect_refused({"view", experiment("paper"), "--port", port}, 3, "cannot_listen", "--port 0");
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(), 0) << view.err();
}

}  // namespace
}  // namespace mixloop
