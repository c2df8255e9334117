// SPDX-License-Identifier: MIT
#include "runtime/protocol/session.hpp"

#include <random>

namespace mixloop {

std::int64_t draw_session() {
  std::random_device random;
  std::int64_t id = 0;
  while (id == 0) id = static_cast<std::int64_t>(std::uint64_t{random()} << 32 | random());
  return id;
}

bool SessionFollower::would_follow(std::int64_t session, Instant at) const {
  if (session == 0) return false;
  if (session == current_) return true;
  if (given_ != 0) return false;
  return plant_.silent(at);
}

void SessionFollower::go_over_to(std::int64_t session) {
  current_ = session;
  if (given_ != 0) given_ = session;
  plant_.begin_again();
}

bool SessionFollower::follow(std::int64_t session, const Received& state, Instant at) {
  const bool first = !plant_.heard() || session != current_ || plant_.sender() != state.sender;
  current_ = session;
  plant_.take(state, at);
  return first;
}

}  // namespace mixloop
