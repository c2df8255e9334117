// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <csignal>

#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"

namespace mixloop {
namespace {

using testing::HasSubstr;

void expect_refused(const std::vector<std::string>& words, int status, const std::string& code,
                    const std::string& message) {
  std::vector<std::string> all = {bin("mixloop"), "view", "--json"};
  all.insert(all.end(), words.begin(), words.end());
  Command command(all);
  EXPECT_EQ(command.wait(), status) << command.out();
  EXPECT_EQ(command.json()["error"]["code"], code) << command.out();
  EXPECT_THAT(command.json()["error"]["message"].get<std::string>(), HasSubstr(message));
}

TEST(View, RefusesWhatItCannotShow) {
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  ScratchFolder folder;
  expect_refused({folder.file("nothing")}, 2, "cannot_read", "no such file");
  expect_refused({folder.write("text", "hello, log")}, 2, "not_a_log", "LCM event log");
  expect_refused({experiment("paper"), "--experiment", experiment("paper")}, 2, "command_line",
                 "is named already");
  const std::string out = folder.file("kept");
  Command simulate({bin("mixloop"), "simulate", experiment("paper"), "--json", "--out", out});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  std::filesystem::remove(out + "/inputs.json");
  expect_refused({out}, 2, "no_scene", "--experiment FILE");
}

TEST(View, ServesUntilItIsStopped) {
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  Command view({bin("mixloop"), "view", experiment("paper"), "--port", "0", "--json"});
  ASSERT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
  const std::string url = view.json()["url"];
  EXPECT_THAT(url, testing::StartsWith("http://127.0.0.1:"));
  // Another one finds the port taken, and says what to do.
  const std::string port = url.substr(17, url.size() - 18);
  expect_refused({experiment("paper"), "--port", port}, 3, "cannot_listen", "--port 0");
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(), 0) << view.err();
}

}  // namespace
}  // namespace mixloop
