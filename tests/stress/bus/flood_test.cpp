// SPDX-License-Identifier: MIT
// Fragments that write past liblcm's heap, and garbage, before the start of every process that listens until
// after its end: nobody falls, hangs, or goes another way.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <random>
#include <thread>

#include "tests/stress/bus/rig.hpp"
#include "tests/stress/figure.hpp"
#include "tests/support/paths.hpp"

namespace mixloop::stress {
namespace {

using namespace std::chrono_literals;

/// Sends to LCM's own group, on this machine only, as fast as it goes.
class Flood {
 public:
  Flood()
      : socket_(::socket(AF_INET, SOCK_DGRAM, 0)), thread_([this] {
          while (!over_) send_some();
        }) {}
  ~Flood() {
    over_ = true;
    thread_.join();
    ::close(socket_);
  }
  Flood(const Flood&) = delete;
  Flood& operator=(const Flood&) = delete;
  std::int64_t sent() const { return sent_; }

 private:
  void send_some() {
    // Two of them are put together as one of 2000 bytes, the second 64 bytes before its begin.
    std::string first("LC03\0\0\0\1\0\0\7\320\0\0\0\0\0\0\0\2MIXLOOP_STATE\0", 34);
    std::string second("LC03\0\0\0\1\0\0\7\320\377\377\377\300\0\1\0\2", 20);
    first.resize(130, 'x'), second.resize(130, 'x');
    send(first), send(second);
    std::string noise(random_() % 300, '\0');
    for (char& c : noise) c = static_cast<char>(random_());
    send(noise);
    // Some pass the kernel's filter.
    if (sent_ % 50 == 0) send(std::string("LC02\0\0\0\1MIXLOOP_STATE\0", 22) + noise);
    if (sent_ % 50 == 25) send(std::string("LC02\0\0\0\1MIXLOOP_COMMAND\0", 24) + noise);
  }
  void send(const std::string& bytes) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(7667);
    inet_pton(AF_INET, "239.255.76.67", &to.sin_addr);
    if (sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) >=
        0)
      ++sent_;
  }

  int socket_;
  std::atomic<bool> over_ = false;
  std::atomic<std::int64_t> sent_ = 0;
  std::mt19937_64 random_{7};
  std::thread thread_;
};

TEST(Flood, FromBeforeTheStartToAfterTheEndOfEveryListener) {
  const std::int64_t datagrams = length(0, 10'000'000);
  const ScratchFolder folder;
  Command alone({bin("mixloop"), "simulate", experiment("paper"), "--json"});
  ASSERT_EQ(alone.wait(), 0);
  const auto expected = alone.json()["trajectory_sha256"];

  Flood flood;
  int rounds = 0;
  do {
    SCOPED_TRACE(++rounds);
    Command run({bin("mixloop"), "run", experiment("paper"), "--json", "--out", folder.file("kept")});
    Command watcher({bin("mixloop"), "monitor", "--json", "--seconds", "0.2", "--patience", "2"});
    Command judge({bin("mixloop"), "track", experiment("paper"), "--attach", "--json", "--patience", "2"});
    if (run.wait(60s) != 0) {
      run.signal(SIGINT);
      FAIL() << run.wait(10s) << run.err() << run.out() << flood.sent();
    }
    EXPECT_EQ(run.json()["trajectory_sha256"], expected) << "it went another way";
    for (Command* listener : {&watcher, &judge}) {
      const int status = listener->wait(60s);
      EXPECT_TRUE(status >= 0 && status <= 3) << status << listener->err();  // it may have come too late
    }
    Command control({bin("mixloop"), "control", "resume", "--patience", "0.1"});
    EXPECT_EQ(control.wait(30s), 3) << "there is no plant any more";
  } while (flood.sent() < datagrams);
  Command doctor({bin("mixloop"), "doctor", "--json"});
  EXPECT_LE(doctor.wait(120s), 3) << doctor.err();
  EXPECT_GT(flood.sent(), 1000);
}

}  // namespace
}  // namespace mixloop::stress
