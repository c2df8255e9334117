// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>

#include "mixloop_lcm/fields.hpp"

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
  sender,       ///< not from the process of this session that sends them (sole_sender.hpp)
};

/// A cause, its name, and the member of TIMING that counts it; a second sender's are among the other
/// sessions'.
struct RejectRow {
  Reject cause;
  std::string_view name;
  std::int64_t timing_t::*timed;
};
inline constexpr std::array kRejects = {
    RejectRow{Reject::length, "length", &timing_t::rejected_length},
    RejectRow{Reject::fingerprint, "fingerprint", &timing_t::rejected_fingerprint},
    RejectRow{Reject::dimension, "dimension", &timing_t::rejected_dimension},
    RejectRow{Reject::not_finite, "not_finite", &timing_t::rejected_not_finite},
    RejectRow{Reject::session, "session", &timing_t::rejected_session},
    RejectRow{Reject::config, "config", &timing_t::rejected_config},
    RejectRow{Reject::tick, "tick", &timing_t::rejected_tick},
    RejectRow{Reject::stale, "stale", &timing_t::rejected_stale},
    RejectRow{Reject::sender, "sender", nullptr}};

/// Dropped messages by cause.
class Rejects {
 public:
  void count(Reject cause) { ++counts_[static_cast<std::size_t>(cause)]; }
  std::uint64_t of(Reject cause) const { return counts_[static_cast<std::size_t>(cause)]; }
  std::uint64_t total() const { return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}); }

 private:
  std::array<std::uint64_t, kRejects.size()> counts_{};
};

/// What TIMING says of a cause.
inline std::int64_t timed(const timing_t& timing, const RejectRow& row) {
  return row.timed != nullptr ? timing.*row.timed : 0;
}

/// As "7 length, 5 session".
std::string to_string(const Rejects& rejects);
std::string dropped_in(const timing_t& timing);

}  // namespace mixloop
