// SPDX-License-Identifier: MIT
#pragma once

#include <linux/filter.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "runtime/bus/endpoint.hpp"
#include "runtime/bus/multicast_route.hpp"
#include "runtime/bus/wire.hpp"

namespace mixloop {

/// A short message of LCM's UDP multicast format, as it came.
struct Received {
  std::int64_t at_us = 0;  ///< when the kernel received it, us since 1970; 0 unless it is asked for that
  Endpoint sender;
  std::string_view channel;
  Bytes data;
};

/// Whether a datagram is a short message ("LC02": magic, sequence number, the channel's name and its end,
/// data); where its parts are. Every length is checked.
bool read_short_message(Bytes datagram, Received& message);

/// Hears a multicast group: short messages, each a datagram. Long ones, which LCM sends in fragments
/// ("LC03"), are none of ours: LCM 1.3.1 puts them together with an offset that wraps. The thread that waits
/// for fd() reads them itself.
class Receiver {
 public:
  enum class Times : bool { unknown, of_receipt };

  /// Attaches the filter before the socket is bound and joins the group: nothing passes by it. Throws
  /// RunFault("bus").
  Receiver(const MulticastGroup& group, std::span<const sock_filter> filter, Times times = Times::unknown);
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Another filter in its place.
  void set_filter(std::span<const sock_filter> filter);

  /// Readable where a datagram waits.
  int fd() const { return socket_; }
  /// The next message that waits, valid until the next call; nullptr where none does. Doesn't block or
  /// allocate.
  const Received* next();

  std::uint64_t malformed() const {
    return malformed_;
  }  ///< datagrams that passed the filter and are no message
  /// Datagrams that the kernel dropped at this socket, by the filter or because it was full (SO_MEMINFO).
  std::uint64_t dropped_by_kernel() const;

 private:
  static constexpr std::size_t kLargest = 65536;  ///< no datagram is larger

  int socket_;
  std::unique_ptr<std::uint8_t[]> datagram_;
  Received message_;
  std::uint64_t malformed_ = 0;
};

}  // namespace mixloop
