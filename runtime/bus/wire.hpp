// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mixloop/command_t.hpp"
#include "mixloop/fault_t.hpp"
#include "mixloop/reference_t.hpp"
#include "mixloop/sim_control_t.hpp"
#include "mixloop/state_t.hpp"
#include "mixloop/stop_t.hpp"
#include "mixloop/timing_t.hpp"
#include "mixloop/truth_t.hpp"

namespace mixloop {

/// Why a received message was dropped.
enum class Reject : std::uint8_t {
  length,       ///< not the length that this type has for its n
  fingerprint,  ///< another type, or another version of it
  dimension,    ///< its n isn't the scene's
  not_finite,   ///< NaN or infinity in it
  session,      ///< of another run
  config,       ///< of another rate, mechanism, path or parameters
  tick,         ///< a tick that can't be: negative, past the end, from the future
  stale,        ///< a tick that is over: doubled, overtaken or replayed
};

inline constexpr std::array kRejects = {Reject::length,     Reject::fingerprint, Reject::dimension,
                                        Reject::not_finite, Reject::session,     Reject::config,
                                        Reject::tick,       Reject::stale};

std::string_view name(Reject cause);

/// Dropped messages by cause.
struct Rejects {
  std::uint64_t length = 0, fingerprint = 0, dimension = 0, not_finite = 0, session = 0, config = 0, tick = 0,
                stale = 0;

  void count(Reject cause);
  std::uint64_t of(Reject cause) const;
  std::uint64_t total() const;
};

using Bytes = std::span<const std::uint8_t>;

/// What every message begins with.
struct Header {
  std::int32_t n = 0;
  std::int64_t utime = 0, seq = 0, session = 0, config = 0;
};

/// Reads the header off the raw bytes; nothing where they are too few.
std::optional<Header> peek(Bytes bytes);

template <class Message>
void set_header(Message& message, const Header& header) {
  message.n = header.n;
  message.utime = header.utime;
  message.seq = header.seq;
  message.session = header.session;
  message.config = header.config;
}

template <class Message>
Header header_of(const Message& m) {
  return {.n = m.n, .utime = m.utime, .seq = m.seq, .session = m.session, .config = m.config};
}

/// A message of this type with this n (motors of COMMAND and REFERENCE, measured coordinates of the others):
/// its arrays have their sizes, everything is zero.
template <class Message>
Message blank(int n);

template <>
state_t blank(int n);
template <>
reference_t blank(int n);
template <>
command_t blank(int n);
template <>
truth_t blank(int n);
template <>
sim_control_t blank(int n);
template <>
stop_t blank(int n);
template <>
fault_t blank(int n);
template <>
timing_t blank(int n);

/// Whether every number in the message is finite.
bool is_finite(const state_t& message);
bool is_finite(const reference_t& message);
bool is_finite(const command_t& message);
bool is_finite(const truth_t& message);
bool is_finite(const sim_control_t& message);
bool is_finite(const stop_t& message);
bool is_finite(const fault_t& message);
bool is_finite(const timing_t& message);

/// Encodes a kept message into a kept buffer; neither allocates after construction.
template <class Message>
class Outbox {
 public:
  explicit Outbox(int n)
      : message(blank<Message>(n)), buffer_(static_cast<std::size_t>(message.getEncodedSize())) {}

  /// The bytes of `message`, valid until the next call.
  Bytes encode() {
    message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
    return buffer_;
  }
  /// The bytes of the last encode().
  Bytes encoded() const { return buffer_; }

  Message message;

 private:
  std::vector<std::uint8_t> buffer_;
};

/// Checks received bytes and decodes them into a kept message, without allocating: length, fingerprint and n
/// on the raw bytes (a generated decoder would allocate whatever n claims), then that all is finite. Session,
/// config and tick are the caller's to check.
template <class Message>
class Inbox {
 public:
  explicit Inbox(int n)
      : message(blank<Message>(n)), n_(n), length_(static_cast<std::size_t>(message.getEncodedSize())) {}

  /// The cause of a rejection, or nothing: then `message` is what the bytes say. A rejected message may
  /// leave anything in `message`, so swap out what must be kept.
  std::optional<Reject> read(Bytes bytes);

  Message message;

 private:
  int n_;
  std::size_t length_;
};

/// The flags of a command whose reference was `ahead` ticks too old, and what they say; 0: its own.
inline std::int32_t extrapolation_flags(std::int64_t ahead) {
  if (ahead == 0) return 0;
  return command_t::FLAG_EXTRAPOLATED | static_cast<std::int32_t>(ahead << command_t::EXTRAPOLATED_SHIFT);
}
inline std::int64_t extrapolated_by(std::int32_t flags) {
  return (flags & command_t::FLAG_EXTRAPOLATED) != 0 ? flags >> command_t::EXTRAPOLATED_SHIFT : 0;
}

extern template class Inbox<state_t>;
extern template class Inbox<reference_t>;
extern template class Inbox<command_t>;
extern template class Inbox<truth_t>;
extern template class Inbox<sim_control_t>;
extern template class Inbox<stop_t>;
extern template class Inbox<fault_t>;
extern template class Inbox<timing_t>;

}  // namespace mixloop
