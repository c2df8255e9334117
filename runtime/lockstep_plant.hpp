// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>

#include "runtime/bus.hpp"
#include "runtime/clock.hpp"
#include "runtime/ending.hpp"
#include "runtime/histogram.hpp"
#include "runtime/stop_switch.hpp"
#include "runtime/wire.hpp"

namespace mixloop {

struct LockstepOptions {
  int n = 0;                   ///< motors
  std::int64_t last_tick = 0;  ///< N: ticks 0 to N are run
  double rate_hz = 1000;       ///< tick k is plant time k / rate_hz
  double speed = 0;            ///< plant seconds a real second; 0: as fast as it goes
  std::int64_t session = 0;    ///< 0: draw one
  std::int64_t config = 0;     ///< see config_hash.hpp
  bool truth = false;          ///< publish TRUTH
  bool hold = false;           ///< go on past the last tick until stopped
  nanoseconds first_resend = std::chrono::milliseconds(5);  ///< STATE again after this silence, then doubling
  nanoseconds slowest_resend = std::chrono::milliseconds(100);
  nanoseconds first_wait = std::chrono::seconds(60);  ///< for the command of tick 0
  nanoseconds patience = std::chrono::seconds(10);    ///< for any later one
};

/// The simulated hardware as lockstep calls it. No function may allocate, lock or throw.
struct PlantSide {
  /// The sensors at the start of a tick.
  std::function<void(std::int64_t tick, std::span<double> psi, std::span<double> psid)> measure;
  /// Takes the tick's command and goes to the start of the next one (at the last tick: records the command).
  /// False: the run is over (divergence), nothing of the next tick may be published.
  std::function<bool(std::int64_t tick, std::span<const double> tau)> advance;
  /// Only where truth is asked for: what was true at the start of the tick. Called after advance(tick), while
  /// the controller works on the next one.
  std::function<void(std::int64_t tick, truth_t& message)> truth;
};

struct LockstepReport {
  std::int64_t session = 0;
  std::int64_t ticks_done = 0;        ///< commands applied: tick 0 to ticks_done - 1
  std::uint64_t resent = 0;           ///< STATEs sent again after tick 0's command, none having come
  std::uint64_t resent_at_start = 0;  ///< the same while waiting for all to be there
  std::uint64_t failed_sends = 0;
  std::uint64_t joined_late = 0;  ///< commands from a controller that said so
  Rejects rejects;
  Histogram round_trip;      ///< first sending of STATE(k) to arrival of COMMAND(k), k > 0
  nanoseconds wall_time{0};  ///< from COMMAND(0) to the last command
  nanoseconds slipped{0};    ///< by which a paced run was late in total
};

/// The plant's side of lockstep: it owns the clock. For every tick it publishes STATE, waits for the COMMAND
/// that answers it, again and again sending the STATE where none comes, and lets the plant advance.
///
/// After start-up a tick costs no allocation, lock or throw of ours.
class LockstepPlant {
 public:
  LockstepPlant(Bus& bus, const StopSwitch& stop, const LockstepOptions& options, PlantSide plant);

  /// Runs to the end and tells the peers that it is over, also where it throws.
  /// Ending::broken_off: `advance` said so. Throws RunFault `lost_peer`, naming the channel that is silent,
  /// or `config_mismatch`, naming what differs.
  Ending run();

  const LockstepReport& report() const { return report_; }  ///< true after run() has thrown, too

 private:
  enum class Answer : std::uint8_t { command, interrupted, stopped };

  Ending run_ticks();
  bool before_end(std::int64_t tick) const { return options_.hold || tick <= options_.last_tick; }
  bool publish_state(std::int64_t tick);
  void publish_truth(std::int64_t tick);
  Answer wait_for_command(std::int64_t tick);
  Answer wait_for_due(std::int64_t tick);
  void send_end(std::int8_t reason);
  void listen_for_planner();
  void stop_listening();
  [[noreturn]] void lost_peer(std::int64_t tick, nanoseconds waited) const;

  void on_command(Bytes bytes);
  void on_stop(Bytes) { stop_heard_ = true; }
  void on_reference(Bytes) { planner_heard_ = true; }

  Bus& bus_;
  const StopSwitch& stop_;
  LockstepOptions options_;
  PlantSide plant_;
  Pacer pacer_;
  LockstepReport report_;

  Outbox<state_t> state_;
  Outbox<truth_t> truth_;
  Outbox<sim_control_t> control_;
  Inbox<command_t> inbox_;
  const std::string state_channel_, truth_channel_, control_channel_, command_channel_;

  std::int64_t tick_ = 0;           // whose command is awaited
  bool command_heard_ = false;      // inbox_.message is that command
  bool controller_agrees_ = false;  // some command had the right config
  bool stop_heard_ = false;
  bool listens_for_planner_ = false;
  bool planner_heard_ = false;
  std::int64_t mismatched_config_ = 0;
  bool mismatch_heard_ = false;
};

}  // namespace mixloop
