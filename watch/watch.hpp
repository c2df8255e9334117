// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "runtime/clock/histogram.hpp"
#include "runtime/protocol/ending.hpp"
#include "runtime/protocol/session.hpp"
#include "watch/any_message.hpp"
#include "watch/channel_count.hpp"
#include "watch/tick_assembly.hpp"

namespace mixloop {

/// A value now, and the one of the largest magnitude so far, each once it is known.
struct Extreme {
  double now = 0, worst = 0;
  bool now_known = false, worst_known = false;

  void set(double value) { now = value, now_known = true; }
  void add(double value);
  void forget_the_worst() { worst = 0, worst_known = false; }
};

struct MotorView {
  Extreme error;                  ///< desired less measured, rad or m
  Extreme torque;                 ///< commanded, N m or N
  std::optional<double> applied;  ///< by TRUTH
  std::optional<double> limit;    ///< of the experiment
  std::string torque_unit;        ///< by the experiment; empty without one
};

/// Time from message to message as the viewer heard them: its own wake-ups are in it.
struct Heard {
  std::uint64_t count = 0;
  nanoseconds p50{0}, p99{0}, max{0};
};

/// How a run stands.
enum class Condition : std::uint8_t {
  silent,
  on_path,
  moving_to_start,
  holding,
  safe_state,
  stopped,
  ended,
  waiting,  ///< the plant repeats a tick that has no answer
  paused,   ///< it repeats one that has
  moving,   ///< without a path
};
inline constexpr std::array kConditionNames = {"silent",     "on_path", "moving_to_start", "holding",
                                               "safe_state", "stopped", "ended",           "waiting",
                                               "paused",     "moving"};

/// All that a viewer shows, at one instant.
struct WatchView {
  std::vector<ChannelView> channels;
  std::int64_t session = 0;          ///< 0: no STATE has been heard
  std::uint64_t other_sessions = 0;  ///< messages of other runs
  std::int64_t tick = 0;
  double plant_time = 0;  ///< s
  bool real_time = false;
  Condition condition{};
  std::optional<Ending> ending;  ///< where it has ended
  std::vector<std::string> warnings;

  std::string position_source;            ///< "experiment", "truth", or "" where there is no position error
  std::optional<Extreme> position_error;  ///< m; nothing before the path
  double worst_at = 0;                    ///< s of plant time
  std::vector<MotorView> motors;
  std::optional<timing_t> timing;
  Heard state_interval, command_after_state;
};

/// Follows one session at a time by what comes over the bus. The worst is of the session since it was first
/// heard, without the move to the path's start.
class Watch {
 public:
  /// `prefix` of the channels. With an experiment there are position errors by its kinematics, and limits;
  /// without one, position errors where TRUTH is sent and there are three motors: else it is not known which
  /// axes count. Without one all that is measured is taken to be driven.
  Watch(const std::string& prefix, std::optional<Experiment> experiment, Instant start);
  ~Watch();

  void take(Channel channel, Bytes bytes, Instant at);
  void forget_the_worst();
  WatchView view(Instant at);
  bool heard_state() const { return session_.current() != 0; }
  bool ended() const { return ending_.has_value(); }  ///< the plant has said END

 private:
  void on(const state_t& state, Instant at);
  void on(const reference_t& reference, Instant at);
  void on(const command_t& command, Instant at);
  void on(const truth_t& truth, Instant at);
  void on(const timing_t& timing, Instant at);
  void on(const sim_control_t& control, Instant at);
  template <class Message>
  bool hear(const Message& message, ChannelCount& count, Instant at);
  void begin(const state_t& state);
  void compare_motors(const HeardTick& tick);
  void compare_with_truth(const HeardTick& tick);
  void compare_position(const Eigen::Vector3d& position, const reference_t& reference, std::int64_t utime);
  Condition condition(Instant at) const;
  std::vector<std::string> warnings(Instant at) const;

  std::optional<Experiment> experiment_;
  std::optional<Equations::Workspace> kinematics_;
  std::vector<ChannelCount> counts_;
  AnyMessage message_;
  SessionFollower session_{0};
  std::size_t n_ = 0, n_u_ = 0;
  TickAssembly ticks_{{}};
  std::int64_t latest_ = -1, latest_command_ = -1;
  Instant state_at_{0};  ///< when the latest STATE was first heard
  Instant heard_at_{0};  ///< when it was last heard
  std::int32_t state_flags_ = 0, command_flags_ = 0, truth_flags_ = 0;
  std::int8_t phase_ = 0;
  bool referred_ = false;    ///< a REFERENCE of the session was heard
  std::int64_t config_ = 0;  ///< the plant's; the others' that were last heard
  std::optional<std::int64_t> command_config_, reference_config_;
  double plant_time_ = 0;
  bool stopped_ = false;
  std::optional<Ending> ending_;
  std::uint64_t other_sessions_ = 0;
  std::optional<Extreme> position_error_;
  double worst_at_ = 0;
  std::vector<MotorView> motors_;
  std::optional<timing_t> timing_;
  Histogram intervals_, answers_;
};

}  // namespace mixloop
