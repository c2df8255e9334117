// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// Of a prefix, bytes: names of LCM's channels have 63 at most, and the longest of ours is SIM_CONTROL's.
constexpr std::size_t kLongestPrefix = 63 - std::string_view("SIM_CONTROL").size();

struct BusOptions {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string prefix = "MIXLOOP_";  ///< of every channel's name
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

  /// Calls `handler(context, bytes)`, from wait(), for every message on the channel. The handler must not
  /// throw.
  using Handler = void (*)(void* context, Bytes bytes);
  void subscribe(const std::string& channel, Handler handler, void* context);

  /// As above, for a member function: `bus.subscribe<&Peer::on_state>(channel, this)`.
  template <auto Method, class Object>
  void subscribe(const std::string& channel, Object* object) {
    subscribe(
        channel, [](void* context, Bytes bytes) { (static_cast<Object*>(context)->*Method)(bytes); }, object);
  }

  /// Takes a subscription back; nothing happens where there is none. Not from within a handler.
  void unsubscribe(const std::string& channel);

  /// Waits for one message, until `deadline`, with the kernel's nanosecond timeouts. A message that is
  /// there is handled even where the deadline is over; a turned switch goes first.
  Wake wait(Instant deadline, const StopSwitch& stop);

 private:
  struct Connection;

  BusOptions options_;
  std::unique_ptr<Connection> connection_;
  std::uint64_t failed_sends_ = 0;
};

}  // namespace mixloop
