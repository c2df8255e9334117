// SPDX-License-Identifier: MIT
#include "runtime/clock/clock.hpp"

#include <cmath>
#include <ctime>

namespace mixloop {

Instant now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + nanoseconds(t.tv_nsec);
}

void sleep_until(Instant due) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(due);
  const timespec t{.tv_sec = seconds.count(), .tv_nsec = (due - seconds).count()};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

Pacer::Pacer(double rate_hz, double speed, nanoseconds slack)
    : rate_hz_(rate_hz), ticks_per_second_(rate_hz * speed), slack_(slack) {}

void Pacer::go_on(std::int64_t tick, Instant at, double speed) {
  ticks_per_second_ = rate_hz_ * speed;
  start_ = at;
  if (paced()) start_ -= due(tick) - start_;
}

Instant Pacer::due(std::int64_t tick) const {
  return start_ + nanoseconds(std::llround(1e9 * static_cast<double>(tick) / ticks_per_second_));
}

void Pacer::began(std::int64_t tick, Instant at) {
  const nanoseconds late = at - due(tick);
  if (late <= slack_) return;
  start_ += late;
  slipped_ += late;
}

}  // namespace mixloop
