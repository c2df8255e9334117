// SPDX-License-Identifier: MIT
#include "runtime/bus/bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "notation/errors.hpp"
#include "tests/runtime/bus/datagram.hpp"

namespace mixloop {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct Ear {
  std::vector<std::string> heard;
  void take(Bytes bytes) { heard.emplace_back(bytes.begin(), bytes.end()); }
};

Bytes as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(Bus, CarriesBytesOnTheChannelsThatAreSubscribed) {
  Bus bus({.prefix = "TEST_"});
  const StopSwitch never;
  Ear a, b;
  EXPECT_EQ(bus.channel("A"), "TEST_A");
  bus.subscribe<&Ear::take>("TEST_A", &a);
  bus.subscribe<&Ear::take>("TEST_B.C", &b);  // a name, not a pattern
  bus.publish("TEST_B_C", as_bytes("no"));
  bus.publish("TEST_X", as_bytes("no"));
  bus.publish("TEST_A", as_bytes("one"));
  bus.publish("TEST_B.C", as_bytes(""));
  while (a.heard.empty() || b.heard.empty()) ASSERT_EQ(bus.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(a.heard, std::vector<std::string>{"one"});
  EXPECT_EQ(b.heard, std::vector<std::string>{""});
  EXPECT_EQ(bus.wait(now() + 20ms, never), Wake::deadline);
}

TEST(Bus, TakesASubscriptionBack) {
  Bus bus;
  const StopSwitch never;
  Ear a, b;
  bus.subscribe<&Ear::take>("A", &a);
  bus.subscribe<&Ear::take>("B", &b);
  bus.unsubscribe("B");
  bus.unsubscribe("C");
  bus.publish("B", as_bytes("no"));
  bus.publish("A", as_bytes("yes"));
  EXPECT_EQ(bus.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(a.heard.size(), 1U);
  bus.subscribe<&Ear::take>("B", &b);
  bus.publish("B", as_bytes("again"));
  EXPECT_EQ(bus.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(b.heard, std::vector<std::string>{"again"});
}

TEST(Bus, HearsSeveralBusesInOneProcess) {
  Bus one, two;
  const StopSwitch never;
  Ear a, b;
  one.subscribe<&Ear::take>("A", &a);
  two.subscribe<&Ear::take>("B", &b);
  one.publish("B", as_bytes("to two"));
  two.publish("A", as_bytes("to one"));
  EXPECT_EQ(one.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(two.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(a.heard.size() + b.heard.size(), 2U);
}

TEST(Bus, KeepsItsDeadline) {
  Bus bus;
  const StopSwitch never;
  bus.subscribe(
      "A", [](void*, const Received&) {}, nullptr);
  const Instant before = now();
  EXPECT_EQ(bus.wait(before + 3ms, never), Wake::deadline);
  EXPECT_GE(now() - before, 3ms);
  EXPECT_EQ(bus.wait(before, never), Wake::deadline) << "one that is over";
}

TEST(Bus, WaitsAwakeWhereItIsTold) {
  Bus bus({.spin = true});
  StopSwitch stop;
  Ear ear;
  bus.subscribe<&Ear::take>("A", &ear);
  bus.publish("A", as_bytes("heard"));
  EXPECT_EQ(bus.wait(now() + 5s, stop), Wake::message);
  EXPECT_EQ(ear.heard, std::vector<std::string>{"heard"});
  const Instant before = now();
  EXPECT_EQ(bus.wait(before + 3ms, stop), Wake::deadline);
  EXPECT_GE(now() - before, 3ms);
  bus.wait_out(before + 6ms, stop);
  EXPECT_GE(now() - before, 6ms);
  std::thread turner([&] { stop.turn(); });
  EXPECT_EQ(bus.wait(now() + 10s, stop), Wake::stop);
  turner.join();
}

TEST(Bus, WakesWhenTheSwitchIsTurned) {
  Bus bus;
  StopSwitch stop;
  bus.subscribe(
      "A", [](void*, const Received&) {}, nullptr);
  std::thread turner([&] {
    std::this_thread::sleep_for(10ms);
    stop.turn();
  });
  Wake wake;
  do wake = bus.wait(now() + 10s, stop);
  while (wake == Wake::message);  // on a busy machine LCM's own test message comes late
  EXPECT_EQ(wake, Wake::stop);
  turner.join();
  EXPECT_EQ(bus.wait(now() + 10s, stop), Wake::stop) << "it stays turned";
}

TEST(StopSwitch, IsTurnedBySigtermAndLetsGoOfIt) {
  {
    StopSwitch stop;
    stop.turn_on_signals();
    EXPECT_THROW(StopSwitch().turn_on_signals(), std::logic_error);
    std::raise(SIGTERM);
    EXPECT_TRUE(stop.turned());
    EXPECT_EQ(stop.signal(), SIGTERM);
  }
  StopSwitch again;
  again.turn_on_signals();
  EXPECT_FALSE(again.turned());
}

TEST(Bus, SurvivesDatagramsThatAreNoMessages) {
  Bus bus;
  const StopSwitch never;
  Ear ear;
  bus.subscribe<&Ear::take>("A", &ear);
  const std::string header("LC02\0\0\0\1", 8);
  send_datagram("");
  send_datagram("LC02");
  send_datagram(header + "A");                                   // a channel without an end
  send_datagram(header + std::string(500, 'A'));                 // a long one
  send_datagram(std::string("LC03") + std::string(60, '\xff'));  // a fragment with hostile offsets
  send_datagram(header + std::string("A\0data", 6));
  ASSERT_EQ(bus.wait(now() + 5s, never), Wake::message);
  EXPECT_EQ(ear.heard, std::vector<std::string>{"data"}) << "the others were dropped on the way";
}

std::string fault_of(const std::string& url) {
  try {
    Bus bus({.url = url});
    return "";
  } catch (const RunFault& fault) {
    return fault.code + ": " + fault.what();
  }
}

TEST(Bus, RefusesABadUrlAndSaysWhatItExpects) {
  for (const char* url : {"", "tcpq://", "udpm://", "udpm://239.255.76.67", "udpm://10.0.0.1:7667",
                          "udpm://x:1", "udpm://239.255.76.67:70000", "udpm://239.255.76.67:76x"}) {
    EXPECT_THAT(fault_of(url), testing::StartsWith("bus_url: ")) << url;
    EXPECT_THAT(fault_of(url), HasSubstr("expected udpm://ADDRESS:PORT")) << url;
  }
}

TEST(Bus, SaysHowToMendAMissingMulticastRoute) {
  // In a child, in a network namespace that has no route at all.
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const std::string text = unshare(CLONE_NEWNET) == 0 ? fault_of(BusOptions{}.url) : "no namespace";
    if (write(ends[1], text.data(), text.size()) < 0) _exit(1);
    _exit(0);
  }
  close(ends[1]);
  char block[2048];
  const ssize_t got = read(ends[0], block, sizeof block);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  const std::string text(block, got > 0 ? static_cast<std::size_t>(got) : 0);
  if (text == "no namespace") GTEST_SKIP() << "not allowed to make one";
  EXPECT_THAT(text, HasSubstr("no_multicast_route: "));
  EXPECT_THAT(text, HasSubstr("239.255.76.67"));
  EXPECT_THAT(text, HasSubstr("the loopback interface is down"));
  EXPECT_THAT(text, HasSubstr("ip link set lo up"));
  EXPECT_THAT(text, HasSubstr("ip route add 224.0.0.0/4 dev lo"));
}

}  // namespace
}  // namespace mixloop
