// SPDX-License-Identifier: MIT
// Datagrams that no receiver may take: random, truncated, oversized, with a wrong n, session, configuration
// or tick, with numbers that aren't, replayed, in fragments, and no LCM at all.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "runtime/bus/wire.hpp"

namespace mixloop::stress {

/// A channel and a sound message on it that is over: sent again it is stale.
struct Original {
  std::string channel;
  std::vector<std::uint8_t> bytes;
  bool has_tick = true;  ///< session, configuration and tick are checked; else its session alone
};

/// Where a message has its first double, after fingerprint and header.
inline constexpr std::size_t kFirstDouble = 44;

class Garbage {
 public:
  Garbage(std::uint64_t seed, std::vector<Original> originals);

  struct Datagram {
    std::vector<std::uint8_t> bytes;  ///< as it goes over the wire
    std::string channel;              ///< empty: the kernel drops it before anybody
    Reject cause = Reject::length;
  };
  const Datagram& next();

 private:
  void spoil(const Original& original);
  void be_random();
  void wrap(const std::string& channel, std::uint32_t magic);

  std::mt19937_64 random_;
  std::vector<Original> originals_;
  std::vector<std::uint8_t> payload_;
  Datagram datagram_;
  std::uint32_t sequence_ = 0;
};

}  // namespace mixloop::stress
