// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "runtime/clock/clock.hpp"
#include "runtime/protocol/sole_sender.hpp"

namespace mixloop {

/// A random id for a run of the plant, never 0.
std::int64_t draw_session();

/// Which session a controller or planner belongs to: the given one for good, or else the first that it
/// hears, and another only when the current one has been quiet. A session is one plant's (sole_sender.hpp).
class SessionFollower {
 public:
  /// `given` 0: none was given.
  explicit SessionFollower(std::int64_t given) : given_(given), current_(given) {}

  /// Whether a STATE of this session, heard now, is to be taken, wherever it comes from.
  bool would_follow(std::int64_t session, Instant at) const;
  /// Whether this one is; one of its session that isn't is a second sender's.
  bool would_follow(std::int64_t session, Endpoint sender, Instant at) const {
    return would_follow(session, at) && (session != current_ || plant_.admits(sender, at));
  }

  /// Takes it. True: it is the first of its session, or of another sender's of the same, and all that is
  /// remembered of ticks must be cleared.
  bool follow(std::int64_t session, const Received& state, Instant at);

  /// The plant itself says that another session comes next.
  void go_over_to(std::int64_t session);

  std::int64_t current() const { return current_; }  ///< 0 before any
  bool heard() const { return plant_.heard(); }
  /// Whether it comes from the session's plant, as far as that is known.
  bool is_the_plants(Endpoint sender) const { return !plant_.sender() || plant_.sender() == sender; }
  SoleSender& plant() { return plant_; }

 private:
  std::int64_t given_, current_;
  SoleSender plant_;
};

}  // namespace mixloop
