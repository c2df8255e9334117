// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>

#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/histogram.hpp"

namespace mixloop {

/// What a plant counts only where commands have a deadline.
struct DeadlineCounts {
  std::int64_t missed = 0, longest_miss = 0;
  double success_last_100 = 1;
};

/// What a plant on the bus is told, in lockstep and in real time.
struct PlantOptions {
  int n = 0;                   ///< measured coordinates: what the plant's messages count
  int n_u = 0;                 ///< motors: what COMMAND's n counts
  std::int64_t last_tick = 0;  ///< N: ticks 0 to N are run
  double rate_hz = 1000;       ///< tick k is plant time k / rate_hz
  double speed = 0;            ///< plant seconds a real second; 0: as fast as it goes
  std::int64_t session = 0;    ///< 0: draw one
  std::int64_t config = 0;     ///< see config_hash.hpp
  bool truth = false;          ///< publish TRUTH
  bool hold = false;           ///< go on past the last tick until stopped
  bool paused = false;         ///< begin paused, at tick 0
  int max_missed = 20;         ///< real time: so many ticks are forgiven
  nanoseconds first_resend = std::chrono::milliseconds(5);  ///< STATE again after this silence, then doubling
  nanoseconds slowest_resend = std::chrono::milliseconds(100);
  nanoseconds first_wait = std::chrono::seconds(60);  ///< for the command of tick 0
  nanoseconds patience = std::chrono::seconds(10);    ///< for any later one
};

/// The simulated hardware as the plant's loops call it. No function may allocate, lock or throw.
struct PlantSide {
  /// The sensors at the start of a tick; true: a reading is stale.
  std::function<bool(std::int64_t tick, std::span<double> psi, std::span<double> psid)> measure;
  /// Lockstep. Takes the tick's command and goes to the start of the next one (at the last tick: records the
  /// command). False: the run is over (divergence), nothing of the next tick may be published.
  std::function<bool(std::int64_t tick, std::span<const double> tau)> advance;
  /// Real time. A command arrives `offset` ns of plant time after the start of the tick in hand.
  std::function<void(const command_t& command, std::int64_t offset)> command;
  /// Real time. Goes on to the start of the next tick. False: as for advance.
  std::function<bool(std::int64_t tick)> finish_tick;
  /// Real time. Brings the safe state; `cause` is a literal.
  std::function<void(const char* cause)> make_safe;
  std::function<bool()> is_safe;
  std::function<DeadlineCounts()> deadlines;
  /// Only where truth is asked for: what was true at the start of the tick. Called after advance(tick), while
  /// the controller works on the next one.
  std::function<void(std::int64_t tick, truth_t& message)> truth;
};

/// What a plant on the bus can tell afterwards.
struct PlantReport {
  std::int64_t session = 0;
  std::int64_t ticks_done = 0;        ///< commands applied: tick 0 to ticks_done - 1
  std::uint64_t resent = 0;           ///< STATEs sent again after tick 0's command, none having come
  std::uint64_t resent_at_start = 0;  ///< the same while waiting for all to be there
  std::uint64_t failed_sends = 0;
  std::uint64_t joined_late = 0;  ///< commands from a controller that said so
  Rejects rejects;
  Histogram round_trip;        ///< first sending of STATE(k) to arrival of COMMAND(k), k > 0
  Histogram wake_up;           ///< where ticks are paced: from a tick's due time until the plant is awake
  std::uint64_t overruns = 0;  ///< ticks begun so late that plant time slipped
  nanoseconds wall_time{0};    ///< from COMMAND(0) to the last command
  nanoseconds slipped{0};      ///< by which a paced run was late in total
};

}  // namespace mixloop
