// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/bus/wire.hpp"

namespace mixloop {

/// Why a plant can't go at a speed, plant seconds a real second (0: as fast as it goes), in words; null where
/// it can.
const char* objection_to_speed(double speed, bool real_time);

/// What an operator asks of the plant's time by SIM_CONTROL: pause, steps, speed, reset. Messages for another
/// session, and the plant's own, are left alone.
class Conductor {
 public:
  /// `real_time`: there is no "as fast as it goes".
  Conductor(int n, std::int64_t session, bool paused, bool real_time = false);

  /// Takes a SIM_CONTROL message; the cause where it is dropped.
  std::optional<Reject> hear(Bytes bytes);

  /// Why the latest speed that was asked for was dropped; null where none was.
  const char* objection() const { return objection_; }

  bool paused() const { return paused_; }
  /// Whether the next tick may begin; while paused, a step that was asked for is used up by it.
  bool lets_go();
  bool reset_asked() const { return reset_; }
  /// The speed that was asked for since the last call; 0: as fast as it goes.
  std::optional<double> new_speed();

 private:
  Inbox<sim_control_t> inbox_;
  std::int64_t session_;
  bool paused_, real_time_, reset_ = false;
  std::int64_t steps_ = 0;
  std::optional<double> speed_;
  const char* objection_ = nullptr;
};

}  // namespace mixloop
