// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "mixloop_lcm/fields.hpp"
#include "runtime/bus/rejects.hpp"

namespace mixloop {

using Bytes = std::span<const std::uint8_t>;

/// What every message begins with, after the fingerprint of its type.
struct Header {
  std::int32_t n = 0;
  std::int64_t utime = 0, seq = 0, session = 0, config = 0;
};

/// Reads the header off the raw bytes; nothing where they are too few.
std::optional<Header> peek(Bytes bytes);

/// The fingerprint that the bytes begin with, as a type's getHash() gives it; 0 where they are too few.
std::int64_t fingerprint(Bytes bytes);

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
Message blank(int n) {
  Message message{};
  message.n = n;
  visit_fields(message, [n]<class Value>(const char*, const char*, Value& value) {
    if constexpr (std::is_same_v<Value, std::vector<double>>) value.assign(static_cast<std::size_t>(n), 0.0);
  });
  return message;
}

/// Whether every number in the message is finite.
template <class Message>
bool is_finite(const Message& message) {
  double sum = 0;  // x - x is zero for a finite x, NaN otherwise
  visit_fields(message, [&sum]<class Value>(const char*, const char*, const Value& value) {
    if constexpr (std::is_same_v<Value, double>)
      sum += value - value;
    else if constexpr (!std::is_integral_v<Value>)
      for (const double x : value) sum += x - x;
  });
  return sum == 0;
}

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

/// Checks the raw bytes against a type's fingerprint and n and the length that follows from them: a generated
/// decoder would allocate whatever n claims. The cause of a rejection, or nothing.
std::optional<Reject> check_raw(Bytes bytes, std::int64_t type, int n, std::size_t length);

/// Decodes bytes into a kept message; false where they aren't of its type to the last one.
template <class Message>
bool decode(Bytes bytes, Message& message) {
  const int size = static_cast<int>(bytes.size());
  return message.decode(bytes.data(), 0, size) == size;
}

/// Checks received bytes and decodes them into a kept message, without allocating: length, fingerprint and n
/// on the raw bytes, then that all is finite. Session, config and tick are the caller's to check.
template <class Message>
class Inbox {
 public:
  explicit Inbox(int n)
      : message(blank<Message>(n)), n_(n), length_(static_cast<std::size_t>(message.getEncodedSize())) {}

  /// The cause of a rejection, or nothing: then `message` is what the bytes say. A rejected message may
  /// leave anything in `message`, so swap out what must be kept.
  std::optional<Reject> read(Bytes bytes) {
    if (const auto cause = check_raw(bytes, Message::getHash(), n_, length_)) return cause;
    if (!decode(bytes, message)) return Reject::length;
    if (!is_finite(message)) return Reject::not_finite;
    return std::nullopt;
  }

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
inline constexpr std::int64_t kFarthestExtrapolated = 32767;  ///< ticks: more the flags can't say

}  // namespace mixloop
