// SPDX-License-Identifier: MIT
// The other side of the bus, as a script: sends messages field by field and looks at what comes back.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <future>
#include <optional>
#include <string>

#include "notation/errors.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/protocol/ending.hpp"

namespace mixloop {

inline constexpr int kScriptN = 3;
inline constexpr std::int64_t kScriptSession = 77, kScriptConfig = 0x0001000200030004;
inline constexpr auto kScriptLimit = std::chrono::seconds(10);
/// How long silence must last to be called that: long for a bus that answers in 0.1 ms.
inline constexpr auto kScriptSilence = std::chrono::milliseconds(60);

class ScriptedPeer {
 public:
  /// Hears these channels, given without the prefix.
  explicit ScriptedPeer(std::initializer_list<const char*> hears) {
    for (const char* name : hears) {
      heard_.push_back({bus.channel(name), {}});
      bus.subscribe<&Channel::take>(heard_.back().name, &heard_.back());
    }
    if (heard_.empty())
      bus.subscribe(
          bus.channel("NOTHING"), [](void*, const Received&) {}, nullptr);
  }

  template <class Message>
  static Message message(std::int64_t tick) {
    return sized<Message>(tick, kScriptN);
  }
  template <class Message>
  static Message sized(std::int64_t tick, int n) {
    Message m = blank<Message>(n);
    set_header(
        m, {.n = n, .utime = 1000 * tick, .seq = tick, .session = kScriptSession, .config = kScriptConfig});
    return m;
  }

  template <class Message>
  void send(const char* channel, const Message& m) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    bus.publish(bus.channel(channel), bytes);
  }
  void send_state(std::int64_t tick) { send("STATE", message<state_t>(tick)); }
  void send_reference(std::int64_t tick, double psi = 0) {
    auto r = message<reference_t>(tick);
    r.psi_desired[0] = psi;
    send("REFERENCE", r);
  }
  void send_end(std::int64_t session = kScriptSession) {
    auto end = message<sim_control_t>(0);
    end.session = session;
    end.action = sim_control_t::ACTION_END;
    send("SIM_CONTROL", end);
  }

  /// The next bytes on a channel; nothing after the limit.
  std::optional<std::vector<std::uint8_t>> next_bytes(const char* channel, nanoseconds limit = kScriptLimit) {
    Channel& c = find(channel);
    const Instant until = now() + limit;
    while (c.queue.empty() && bus.wait(until, never_) == Wake::message) {
    }
    if (c.queue.empty()) return std::nullopt;
    auto bytes = std::move(c.queue.front());
    c.queue.pop_front();
    return bytes;
  }
  template <class Message>
  std::optional<Message> next(const char* channel, nanoseconds limit = kScriptLimit) {
    const auto bytes = next_bytes(channel, limit);
    if (!bytes) return std::nullopt;
    Inbox<Message> inbox(kScriptN);
    EXPECT_EQ(inbox.read(*bytes), std::nullopt) << channel;
    return inbox.message;
  }
  bool silent(const char* channel) { return !next_bytes(channel, kScriptSilence); }

  Bus bus;

 private:
  struct Channel {
    std::string name;
    std::deque<std::vector<std::uint8_t>> queue;
    void take(Bytes bytes) { queue.emplace_back(bytes.begin(), bytes.end()); }
  };
  Channel& find(const char* channel) {
    for (Channel& c : heard_)
      if (c.name == bus.channel(channel)) return c;
    throw std::logic_error(channel);
  }

  std::deque<Channel> heard_;
  StopSwitch never_;
};

/// Runs a peer (or plant) in a thread of its own, with its own bus; ends it with the test.
template <class Peer>
class RunningPeer {
 public:
  template <class... Arguments>
  explicit RunningPeer(Arguments&&... arguments) : peer(bus_, stop, std::forward<Arguments>(arguments)...) {
    ending_ = std::async(std::launch::async, [this] { return peer.run(); });
  }
  ~RunningPeer() { stop.turn(); }

  bool running() const { return ending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready; }

  /// How run() ended; rethrows what it threw.
  Ending ending() {
    if (ending_.wait_for(kScriptLimit) != std::future_status::ready) {
      ADD_FAILURE() << "still running";
      stop.turn();
    }
    return ending_.get();
  }
  /// The code of the RunFault that run() threw, and what it says; empty where it ended without.
  std::string fault() {
    try {
      ending();
      return "";
    } catch (const RunFault& f) {
      return f.code + ": " + f.what();
    }
  }

 private:
  Bus bus_;

 public:
  StopSwitch stop;
  Peer peer;

 private:
  std::future<Ending> ending_;
};

}  // namespace mixloop
