// SPDX-License-Identifier: MIT
#include "runtime/bus/wire.hpp"

#include "runtime/bus/big_endian.hpp"

namespace mixloop {
namespace {

constexpr std::size_t kFingerprint = 8, kMessageHeader = kFingerprint + 4 + 4 * 8;

}  // namespace

std::optional<Header> peek(Bytes bytes) {
  if (bytes.size() < kMessageHeader) return std::nullopt;
  const std::uint8_t* at = bytes.data() + kFingerprint;
  return Header{.n = big_endian<std::int32_t>(at),
                .utime = big_endian<std::int64_t>(at + 4),
                .seq = big_endian<std::int64_t>(at + 12),
                .session = big_endian<std::int64_t>(at + 20),
                .config = big_endian<std::int64_t>(at + 28)};
}

std::int64_t fingerprint(Bytes bytes) {
  return bytes.size() < kFingerprint ? 0 : big_endian<std::int64_t>(bytes.data());
}

std::optional<Reject> check_raw(Bytes bytes, std::int64_t type, int n, std::size_t length) {
  // What n claims is checked before the length that follows from it, so that a wrong n is called that.
  const std::optional<Header> header = peek(bytes);
  if (!header) return Reject::length;
  if (fingerprint(bytes) != type) return Reject::fingerprint;
  if (header->n != n) return Reject::dimension;
  if (bytes.size() != length) return Reject::length;
  return std::nullopt;
}

}  // namespace mixloop
