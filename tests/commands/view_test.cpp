// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <sstream>

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

/// Processor time that a process has taken, in ticks of the kernel's.
long taken(int pid) {
  std::istringstream stat(bytes_of("/proc/" + std::to_string(pid) + "/stat"));
  std::string skipped;
  for (int i = 1; i < 14; ++i) stat >> skipped;
  long user = 0, system = 0;
  stat >> user >> system;
  return user + system;
}

int connected(int port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  return fd;
}

// Whoever can't be let in for want of descriptors waits, and the server meanwhile takes next to no time.
TEST(View, WaitsWhereItHasNoDescriptorsLeft) {
  if (!MIXLOOP_HAS_PAGES) GTEST_SKIP() << "built without npm";
  Command view(
      {"/bin/sh", "-c",
       "ulimit -n 40; exec '" + bin("mixloop") + "' view '" + experiment("paper") + "' --port 0 --json"});
  ASSERT_TRUE(eventually([&] { return view.out().ends_with("}\n"); })) << view.err();
  const std::string url = view.json()["url"];
  const int port = std::stoi(url.substr(17));
  std::vector<int> visitors;
  for (int i = 0; i < 60; ++i) visitors.push_back(connected(port));
  const long before = taken(view.pid());
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_LT(taken(view.pid()) - before, sysconf(_SC_CLK_TCK) / 5) << "it spins";
  for (const int visitor : visitors) close(visitor);
  const int late = connected(port);
  const std::string request = "GET /nothing HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
  ASSERT_EQ(write(late, request.data(), request.size()), static_cast<ssize_t>(request.size()));
  char answer[13] = {};
  EXPECT_EQ(recv(late, answer, 12, MSG_WAITALL), 12);
  EXPECT_STREQ(answer, "HTTP/1.1 404");
  close(late);
}

}  // namespace
}  // namespace mixloop
