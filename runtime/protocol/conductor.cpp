// SPDX-License-Identifier: MIT
#include "runtime/protocol/conductor.hpp"

#include <algorithm>

#include "runtime/clock/plant_time.hpp"

namespace mixloop {

namespace {

constexpr double kSlowest = 1e-6;  // slower, a tick's due time is past what the clock counts

}  // namespace

const char* objection_to_speed(double speed, bool real_time) {
  if (speed == 0)
    return real_time ? "in real time there is no 'max': expected a factor such as 0.1, 1 or 10 (lockstep, "
                       "without --realtime, goes as fast as it can)"
                     : nullptr;
  if (!(speed >= kSlowest))
    return "below 1e-6 of real time a tick's end is past what the clock counts: expected 1e-6 or more; "
           "`mixloop control pause` and `step` go slower";
  return nullptr;
}

Conductor::Conductor(int n, std::int64_t session, bool paused, bool real_time)
    : inbox_(n), session_(session), paused_(paused), real_time_(real_time) {}

std::optional<Reject> Conductor::hear(Bytes bytes) {
  if (const auto cause = inbox_.read(bytes)) return cause;
  const sim_control_t& control = inbox_.message;
  if (control.session != session_) return Reject::session;
  switch (control.action) {
    case sim_control_t::ACTION_PAUSE:
      paused_ = true;
      break;
    case sim_control_t::ACTION_RESUME:
      paused_ = false;
      steps_ = 0;
      break;
    case sim_control_t::ACTION_STEP:
      if (control.seq < 1 || control.seq > kFarthestTick) return Reject::tick;
      paused_ = true;
      steps_ = std::min(steps_ + control.seq, kFarthestTick);
      break;
    case sim_control_t::ACTION_RESET:
      reset_ = true;
      break;
    case sim_control_t::ACTION_SPEED:
      objection_ = objection_to_speed(control.speed, real_time_);
      if (objection_ != nullptr) return Reject::tick;
      speed_ = control.speed;
      break;
    default:  // END is the plant's own
      break;
  }
  return std::nullopt;
}

bool Conductor::lets_go() {
  if (!paused_) return true;
  if (steps_ == 0) return false;
  --steps_;
  return true;
}

std::optional<double> Conductor::new_speed() {
  const auto speed = speed_;
  speed_.reset();
  return speed;
}

}  // namespace mixloop
