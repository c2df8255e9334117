// SPDX-License-Identifier: MIT
// Garbage on every channel while the paper's robot goes its way: the same bytes as without, memory as it was,
// and every datagram counted by its cause.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/stress/bus/garbage.hpp"
#include "tests/stress/bus/rig.hpp"
#include "tests/stress/figure.hpp"

namespace mixloop::stress {
namespace {

using namespace std::chrono_literals;

constexpr int kPort = 7667;

/// Sends to LCM's own group, on this machine only, and never faster than the receivers' sockets can take it.
class Sender {
 public:
  explicit Sender(BusRig& rig) : rig_(rig), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const unsigned char ttl = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    to_.sin_family = AF_INET;
    to_.sin_port = htons(kPort);
    inet_pton(AF_INET, "239.255.76.67", &to_.sin_addr);
  }
  ~Sender() { ::close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  bool send(const std::vector<std::uint8_t>& bytes) {
    unread_ += bytes.size() + 1000;
    if (unread_ > 50'000) wait_for_receivers();
    return sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
                  sizeof to_) == static_cast<ssize_t>(bytes.size());
  }

  /// Datagrams that found a full socket, in this network namespace.
  static std::int64_t lost() {
    std::ifstream snmp("/proc/net/snmp");
    std::string names, line;
    while (std::getline(snmp, line) && !line.starts_with("Udp:")) {
    }
    names = line;
    std::getline(snmp, line);
    std::istringstream name(names), value(line);
    std::string what, count;
    while (name >> what && value >> count)
      if (what == "RcvbufErrors") return std::stoll(count);
    return -1;
  }

 private:
  /// One of them is the rig.
  void wait_for_receivers() {
    for (int i = 0; i < 20'000 && longest_queue() > 20'000; ++i) {
      rig_.hear();
      ::usleep(100);
    }
    unread_ = 0;
  }
  static std::int64_t longest_queue() {
    std::ifstream sockets("/proc/net/udp");
    std::string line;
    std::getline(sockets, line);
    std::int64_t longest = 0;
    while (std::getline(sockets, line)) {
      unsigned port = 0;
      unsigned long queue = 0;
      if (std::sscanf(line.c_str(), "%*d: %*x:%x %*x:%*x %*x %*x:%lx", &port, &queue) == 2 && port == kPort)
        longest = std::max(longest, static_cast<std::int64_t>(queue));
    }
    return longest;
  }

  BusRig& rig_;
  int socket_;
  sockaddr_in to_{};
  std::size_t unread_ = 0;
};

using Counts = std::map<std::string, std::int64_t>;  // by cause

std::int64_t total(const Counts& counts) {
  std::int64_t sum = 0;
  for (const auto& [cause, count] : counts) sum += count;
  return sum;
}

/// What the plant says that it has dropped.
Counts counted(const timing_t& t) {
  Counts counts;
  for (const RejectRow& row : kRejects) counts[std::string(row.name)] = timed(t, row);
  return counts;
}

/// What each process must have dropped.
class Expected {
 public:
  void count(const Garbage::Datagram& d) {
    for (const Part part : kParts)
      if (hears(part, d.channel))
        ++counts_[static_cast<std::size_t>(part)]
                 [std::string(kRejects[static_cast<std::size_t>(d.cause)].name)];
  }
  const Counts& of(Part part) const { return counts_[static_cast<std::size_t>(part)]; }
  std::int64_t total(Part part) const { return stress::total(of(part)); }

 private:
  static bool hears(Part part, const std::string& channel) {
    if (channel.empty()) return false;
    const auto is = [&](const char* name) { return channel.ends_with(name); };
    if (is("SIM_CONTROL")) return true;
    if (part == Part::plant) return is("COMMAND") || is("FAULT");
    return is("STATE") || (part == Part::controller && is("REFERENCE"));
  }
  std::array<Counts, kParts.size()> counts_;
};

/// "...: 12 messages dropped: 7 length, 5 session".
Counts told(const std::string& err) {
  Counts counts;
  const auto at = err.find("messages dropped: ");
  if (at == std::string::npos) return counts;
  std::istringstream words(err.substr(at + std::string("messages dropped: ").size()));
  std::int64_t count = 0;
  for (std::string cause; words >> count >> cause;) {
    if (cause.ends_with(',')) cause.pop_back();
    counts[cause] = count;
  }
  return counts;
}

/// What is resent in lockstep is stale for a good reason; all else is ours alone, but for what found a socket
/// full.
void expect_counted(const Counts& expected, const Counts& found, std::int64_t lost) {
  for (const auto& [cause, count] : expected) {
    const auto at = found.find(cause);
    const std::int64_t there = at == found.end() ? 0 : at->second;
    EXPECT_GE(there, count - lost) << cause;
    EXPECT_TRUE(cause == "stale" || there <= count) << cause << ": " << there << " of " << count;
  }
}

std::string simulated_hash(const std::vector<std::string>& sets) {
  std::vector<std::string> words = {MIXLOOP_BIN "/mixloop",
                                    "simulate",
                                    MIXLOOP_EXPERIMENTS "/soak.yaml",
                                    "--json",
                                    "--set",
                                    "plant.torque_limit=[3, 8, 4]",
                                    "--set",
                                    "controller.safety.torque_limit=[3, 8, 4]"};
  words.insert(words.end(), sets.begin(), sets.end());
  Command command(words);
  EXPECT_EQ(command.wait(), 0) << command.err();
  return command.json()["trajectory_sha256"];
}

template <class Message>
Original original(const BusRig& rig, const char* channel, bool has_tick) {
  Outbox<Message> out(BusRig::kMotors);
  set_header(out.message, header_of(rig.state));
  const Bytes bytes = out.encode();
  return {rig.bus.channel(channel), {bytes.begin(), bytes.end()}, has_tick};
}

/// The early messages of the run in hand, and what an operator sends.
std::vector<Original> originals(BusRig& rig) {
  std::vector<Original> all;
  const char* const names[] = {"STATE", "REFERENCE", "COMMAND"};
  for (std::size_t i = 0; i < 3; ++i) all.push_back({rig.bus.channel(names[i]), rig.first_bytes[i], true});
  all.push_back(original<sim_control_t>(rig, "SIM_CONTROL", false));
  all.push_back(original<fault_t>(rig, "FAULT", false));
  return all;
}

TEST(Datagrams, OfGarbageAreDroppedAndCountedAndChangeNothing) {
  const std::int64_t datagrams = length(100'000, 10'000'000);
  const std::vector<std::string> sets = {"--set", "path.repeat=" + std::to_string(length(3, 30))};
  std::vector<std::string> line = sets;
  line.insert(line.end(), {"--session", "4711"});
  BusRig rig(line, {"--allow-faults"});
  rig.start_all();
  ASSERT_TRUE(rig.until([&] { return rig.command.seq > 200; }, 30s));
  for (const char* channel : {"STATE", "REFERENCE", "TRUTH"}) rig.bus.unsubscribe(rig.bus.channel(channel));

  Garbage garbage(3, originals(rig));
  Sender sender(rig);
  Expected expected;
  // LCM's ring of received messages begins with 200 kB, doubles with the longest backlog, and stays. A leak
  // of a byte a datagram would be 8 MB of the 1e7.
  Figure growth("datagrams_memory", "kB that a process has grown by", growth_bound(1024), datagrams);
  std::array<long, kParts.size()> before{};
  const std::int64_t lost_before = Sender::lost();
  const auto behind = [&] {
    return expected.total(Part::plant) - (rig.timing ? total(counted(*rig.timing)) : 0);
  };
  for (std::int64_t i = 0; i < datagrams; ++i) {
    const auto& datagram = garbage.next();
    ASSERT_TRUE(sender.send(datagram.bytes));
    expected.count(datagram);
    // Who answers a later state has read what was sent before it: LCM never keeps more than this for a
    // process that the machine holds up.
    if (i % 100 == 0) {
      const std::int64_t before_these = rig.answered;
      ASSERT_TRUE(rig.until([&] { return rig.answered >= before_these + 3; }, 30s)) << "somebody hangs";
    }
    for (const Part part : kParts) {
      auto& at_first = before[static_cast<std::size_t>(part)];
      if (i == datagrams / 5) at_first = rig.memory(part);
      if (i > datagrams / 5 && i % (datagrams / 20) == 0)
        growth.look(static_cast<double>(rig.memory(part) - at_first), [&] { return name_of(part); });
    }
  }
  const auto lost = [&] { return Sender::lost() - lost_before; };
  ASSERT_TRUE(rig.until([&] { return behind() <= lost() && rig.timing->seq > 2000 * length(3, 30); }, 300s));

  const std::int64_t lost_in_all = lost();  // a process takes its socket's count with it
  rig.process(Part::plant).signal(SIGINT);
  EXPECT_EQ(rig.process(Part::plant).wait(), 0) << rig.process(Part::plant).err();
  const auto result = rig.process(Part::plant).json();
  EXPECT_EQ(result["trajectory_sha256"], simulated_hash(sets)) << "it went another way";
  expect_counted(expected.of(Part::plant), counted(*rig.timing),
                 lost_in_all);  // the result is of the path's end
  for (const Part part : {Part::planner, Part::controller}) {
    SCOPED_TRACE(name_of(part));
    EXPECT_EQ(rig.process(part).wait(), 0);
    expect_counted(expected.of(part), told(rig.process(part).err()), lost_in_all);
  }
}

}  // namespace
}  // namespace mixloop::stress
