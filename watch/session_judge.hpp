// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "loop/recorder.hpp"
#include "loop/result.hpp"
#include "watch/tick_assembly.hpp"

namespace mixloop {

/// Judges one session by the STATEs and COMMANDs that are heard of it, from the first STATE to its END.
/// Messages of different senders may overtake each other: a tick is judged once both are there.
class SessionJudge {
 public:
  /// The session is the first one heard of this experiment. What is passed must outlive it.
  SessionJudge(const Experiment& experiment, const Plan& plan);
  SessionJudge(const SessionJudge&) = delete;
  SessionJudge& operator=(const SessionJudge&) = delete;

  void on_state(Bytes bytes);
  void on_command(Bytes bytes);
  void on_control(Bytes bytes);

  std::int64_t session() const { return session_; }        ///< 0: none was heard
  std::int64_t latest() const { return ticks_.newest(); }  ///< tick of a STATE, -1 before any
  /// The session is over; what is not complete may still be under way.
  bool ended() const { return last_tick_.has_value() || over(); }
  /// Nothing more is awaited: all ticks of a session that has ended are judged, or it has diverged.
  bool over() const { return diverged_ || (last_tick_ && judged_ >= *last_tick_); }

  /// Judges what is left, complete or not, and gives the measures of what was heard; `missing_ticks` says
  /// how much was not, and then there is no trajectory_sha256.
  Result finish(bool interrupted, double wall_time);

  const Equations& equations() const { return recorder_.equations(); }

 private:
  void judge(const HeardTick& tick);
  void end_at(std::int64_t tick) { last_tick_ = std::min(tick, plan_.ticks()); }

  const Experiment& experiment_;
  const Plan& plan_;
  Recorder recorder_;
  std::int64_t config_;
  Inbox<state_t> states_;
  Inbox<command_t> commands_;
  Inbox<sim_control_t> controls_;
  TickAssembly ticks_;
  std::optional<command_t> early_;  ///< the latest COMMAND before any STATE
  std::int64_t session_ = 0;
  std::int64_t judged_ = -1, complete_ = 0;
  std::optional<std::int64_t> last_tick_;  ///< of a session that has ended
  bool diverged_ = false, safe_ = false;
  bool broken_off_ = false;  ///< its END said that it had not finished
};

}  // namespace mixloop
