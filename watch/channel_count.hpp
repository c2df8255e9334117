// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "runtime/clock/clock.hpp"

namespace mixloop {

/// What came over a channel, as a viewer heard it.
struct ChannelView {
  std::string name;
  std::uint64_t received = 0;
  double rate_hz = 0;                 ///< over the last second or so
  std::optional<double> age;          ///< s since the last message; nothing where none came
  std::optional<std::uint64_t> lost;  ///< ticks that were skipped; nothing where messages don't come by tick
  std::uint64_t repeated = 0;         ///< of a tick that was there already
  std::uint64_t bad = 0;              ///< of another type, length or n, or not finite
};

/// Counts a channel's messages. Losses are counted from the first tick heard of a session on; one that is
/// overtaken counts as lost and as repeated.
class ChannelCount {
 public:
  ChannelCount(std::string name, bool by_tick, Instant start)
      : name_(std::move(name)), by_tick_(by_tick), samples_{{start, 0}} {}

  void heard(Instant at) { ++received_, last_ = at; }
  void bad() { ++bad_; }
  void new_session() { latest_ = -1; }
  /// The tick that the message was of; nothing where messages don't come by tick.
  void tick(std::int64_t seq);

  /// What was counted. Rates are over the time since the first call of the last second.
  ChannelView view(Instant at);

 private:
  struct Sample {
    Instant at;
    std::uint64_t received;
  };

  std::string name_;
  bool by_tick_;
  std::uint64_t received_ = 0, lost_ = 0, repeated_ = 0, bad_ = 0;
  std::int64_t latest_ = -1;
  std::optional<Instant> last_;
  std::deque<Sample> samples_;
};

}  // namespace mixloop
