// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/clock/clock.hpp"

namespace mixloop {

/// A random id for a run of the plant, never 0.
std::int64_t draw_session();

/// Which session a controller or planner belongs to: the given one for good, or else the first that it
/// hears, and another only when the current one has been quiet.
class SessionFollower {
 public:
  /// `given` 0: none was given.
  explicit SessionFollower(std::int64_t given, nanoseconds quiet = std::chrono::seconds(1))
      : given_(given), current_(given), quiet_(quiet) {}

  /// Whether a STATE of this session, heard now, is to be taken.
  bool would_follow(std::int64_t session, Instant at) const;

  /// Takes it. True: it is the first of its session, and all that is remembered of ticks must be cleared.
  bool follow(std::int64_t session, Instant at);

  /// The plant itself says that another session comes next.
  void go_over_to(std::int64_t session);

  std::int64_t current() const { return current_; }  ///< 0 before any
  bool heard() const { return last_heard_.has_value(); }

 private:
  std::int64_t given_, current_;
  nanoseconds quiet_;
  std::optional<Instant> last_heard_;
};

}  // namespace mixloop
