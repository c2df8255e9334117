// SPDX-License-Identifier: MIT
#include "tests/stress/bus/garbage.hpp"

#include <cmath>
#include <cstring>
#include <limits>

namespace mixloop::stress {
namespace {

constexpr std::uint32_t kShort = 0x4c433032, kFragment = 0x4c433033;            // "LC02", "LC03"
constexpr std::size_t kDimension = 8, kTick = 20, kSession = 28, kConfig = 36;  // in a message's bytes

template <class Number>
void put(std::vector<std::uint8_t>& bytes, std::size_t at, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes[at + i] = static_cast<std::uint8_t>(number >> 8 * (sizeof number - 1 - i));
}

}  // namespace

Garbage::Garbage(std::uint64_t seed, std::vector<Original> originals)
    : random_(seed), originals_(std::move(originals)) {}

const Garbage::Datagram& Garbage::next() {
  const Original& original = originals_[random_() % originals_.size()];
  const std::uint64_t kind = random_() % 100;
  if (kind < 4) {  // not LCM's at all
    datagram_.channel.clear();
    datagram_.bytes.resize(random_() % 400);
    for (auto& byte : datagram_.bytes) byte = static_cast<std::uint8_t>(random_());
    if (datagram_.bytes.size() >= 4) put(datagram_.bytes, 0, std::uint32_t{0xdeadbeef});
    return datagram_;
  }
  payload_ = original.bytes;
  if (kind < 8) {  // a fragment of a message that never comes whole
    wrap(original.channel, kFragment);
    datagram_.channel.clear();
    return datagram_;
  }
  datagram_.channel = original.channel;
  spoil(original);
  wrap(original.channel, kShort);
  return datagram_;
}

void Garbage::spoil(const Original& original) {
  const std::uint64_t kinds = original.has_tick ? 8 : 5;
  switch (random_() % kinds) {
    case 0:
      return be_random();
    case 1:
      datagram_.cause = Reject::length;
      return payload_.resize(random_() % payload_.size());
    case 2:
      datagram_.cause = Reject::length;
      return payload_.resize(payload_.size() + 1 + random_() % (random_() % 64 == 0 ? 60000 : 1200), 0x55);
    case 3:
      datagram_.cause = Reject::dimension;
      return put(payload_, kDimension, static_cast<std::uint32_t>(random_()) | 0x100U);  // not 3
    case 4:
      datagram_.cause = Reject::session;
      return put(payload_, kSession, random_());
    case 5: {
      datagram_.cause = Reject::not_finite;
      const double inf = std::numeric_limits<double>::infinity();
      const double numbers[] = {std::nan(""), inf, -inf};
      std::uint64_t bits = 0;
      std::memcpy(&bits, &numbers[random_() % 3], sizeof bits);
      return put(payload_, kFirstDouble + 8 * (random_() % 3), bits);
    }
    case 6:
      datagram_.cause = Reject::config;
      return put(payload_, kConfig, random_());
    default:
      if (random_() % 2 == 0) {
        datagram_.cause = Reject::stale;
        return;
      }
      datagram_.cause = Reject::tick;
      const bool answer = original.channel.ends_with("COMMAND");  // one of the past is stale
      return put(payload_, kTick, answer ? std::uint64_t{1} << 60 : static_cast<std::uint64_t>(-5));
  }
}

void Garbage::be_random() {
  payload_.resize(random_() % 300);
  for (auto& byte : payload_) byte = static_cast<std::uint8_t>(random_());
  datagram_.cause = payload_.size() < kFirstDouble ? Reject::length : Reject::fingerprint;
}

void Garbage::wrap(const std::string& channel, std::uint32_t magic) {
  auto& bytes = datagram_.bytes;
  bytes.resize(8 + channel.size() + 1 + payload_.size());
  put(bytes, 0, magic);
  put(bytes, 4, ++sequence_);
  std::memcpy(bytes.data() + 8, channel.c_str(), channel.size() + 1);
  if (!payload_.empty()) std::memcpy(bytes.data() + 8 + channel.size() + 1, payload_.data(), payload_.size());
}

}  // namespace mixloop::stress
