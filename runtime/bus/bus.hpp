// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "runtime/bus/receiver.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// Of a prefix, bytes: names of LCM's channels have 63 at most, and the longest of ours is SIM_CONTROL's.
constexpr std::size_t kLongestPrefix = 63 - std::string_view("SIM_CONTROL").size();

struct BusOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "MIXLOOP_";  ///< of every channel's name
  bool spin = false;                ///< wait awake: for who has a core of its own
};

/// What a wait ended with.
enum class Wake : std::uint8_t {
  message,   ///< one message was received and handed to its handler
  deadline,  ///< none came in time
  stop,      ///< the stop switch is turned
};

/// A connection to the LCM bus. One thread uses it: liblcm sends, and the thread that waits reads what was
/// received (receiver.hpp).
///
/// The first subscription joins the multicast group. The kernel drops every datagram that isn't a short LCM
/// message on a subscribed channel (channel_filter.hpp) from before that on; messages beyond 64 kB, which LCM
/// sends in fragments, are not received.
class Bus {
 public:
  /// Throws RunFault `no_multicast_route`, with the commands that mend it, or `bus`.
  explicit Bus(BusOptions options = {});
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// The full name of a channel, as channel("STATE") -> "MIXLOOP_STATE".
  std::string channel(std::string_view name) const { return options_.prefix + std::string(name); }

  /// Sends the bytes; what the kernel refuses is counted, not thrown: to the others it is a lost datagram.
  /// Doesn't allocate.
  void publish(const std::string& channel, Bytes bytes);
  std::uint64_t failed_sends() const { return failed_sends_; }
  /// Datagrams that came and were dropped: by the kernel (on other channels, in fragments, or because too
  /// many waited), or as no message.
  std::uint64_t dropped() const;

  /// What was just sent has an answer that is likely to be there in a moment: waits stay awake for so long,
  /// where there is a core for who answers. A core that goes to sleep is woken in as much time; where answers
  /// turn out to take longer, it is only tried now and then.
  void expect_answer();
  static constexpr nanoseconds kMoment = std::chrono::microseconds(50);

  /// Calls `handler(context, message)`, from wait(), for every message on the channel. The handler must not
  /// throw.
  using Handler = void (*)(void* context, const Received& message);
  void subscribe(const std::string& channel, Handler handler, void* context);

  /// As above, for a member function that takes the message or its bytes:
  /// `bus.subscribe<&Peer::on_state>(channel, this)`.
  template <auto Method, class Object>
  void subscribe(const std::string& channel, Object* object) {
    subscribe(
        channel,
        [](void* context, const Received& message) {
          if constexpr (std::is_invocable_v<decltype(Method), Object&, const Received&>)
            (static_cast<Object*>(context)->*Method)(message);
          else
            (static_cast<Object*>(context)->*Method)(message.data);
        },
        object);
  }

  /// Takes a subscription back; nothing happens where there is none. Not from within a handler.
  void unsubscribe(const std::string& channel);

  /// Waits for one message, until `deadline`, with the kernel's nanosecond timeouts, or awake where the
  /// options say so. A message that is there is handled even where the deadline is over; a turned switch goes
  /// first.
  Wake wait(Instant deadline, const StopSwitch& stop);
  /// Waits for an instant in the same way; messages wait too. May return early where a signal was handled.
  void wait_out(Instant due, const StopSwitch& stop) const;

 private:
  struct Connection;

  std::optional<Wake> wait_awake(Instant until, Instant deadline, const StopSwitch& stop);
  std::optional<Wake> wait_for_answer(Instant deadline, const StopSwitch& stop);
  bool take();

  BusOptions options_;
  std::unique_ptr<Connection> connection_;
  std::uint64_t failed_sends_ = 0;
  bool has_cores_;
  std::optional<Instant> awake_until_;  ///< an answer is expected
  int luck_ = kMostLuck;                ///< with the latest ones
  static constexpr int kMostLuck = 16, kNoLuck = -64;
};

}  // namespace mixloop
