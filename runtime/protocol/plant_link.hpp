// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "runtime/bus/bus.hpp"
#include "runtime/bus/wire.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/stop_switch.hpp"
#include "runtime/protocol/config_agreement.hpp"
#include "runtime/protocol/config_hash.hpp"
#include "runtime/protocol/dropped.hpp"
#include "runtime/protocol/ending.hpp"
#include "runtime/protocol/session.hpp"

namespace mixloop {

/// What a controller or planner is told.
struct PeerOptions {
  int n = 0;                 ///< measured coordinates: what STATE's n counts
  int n_u = 0;               ///< motors: what COMMAND's and REFERENCE's n counts
  std::int64_t session = 0;  ///< 0: take the one that is heard
  std::int64_t config = 0;   ///< see config_hash.hpp
  ConfigWords config_words;  ///< what it is of
  double rate_hz = 1000;     ///< ticks a second of plant time
  bool references = true;    ///< there is a planner; without a path nobody sends or awaits REFERENCEs
  /// Later ticks are rejected, but for a plant that holds; and a plant may fall silent after it.
  std::int64_t last_tick = std::numeric_limits<std::int64_t>::max();
  nanoseconds first_wait = std::chrono::seconds(60);  ///< for the first STATE
  nanoseconds patience = std::chrono::seconds(10);    ///< for any later one
  int max_missed = 20;  ///< real time: so many ticks a reference is extrapolated, a silent plant waited for
  /// Told of what a person should look after, as of a second sender: at most once of each kind. Optional.
  std::function<void(const std::string&)> notice;
};

/// What a controller or planner can tell afterwards.
struct PeerReport {
  std::int64_t session = 0;         ///< 0: none was heard
  std::uint64_t answered = 0;       ///< ticks answered for the first time
  std::uint64_t repeated = 0;       ///< answers sent again
  std::uint64_t extrapolated = 0;   ///< real time: references
  std::uint64_t safe_commands = 0;  ///< real time: sent in place of the law's
  std::int64_t latest = -1;         ///< the latest tick heard
  bool joined_late = false;         ///< first heard its session at a tick past 0
  std::uint64_t failed_sends = 0;
  std::uint64_t dropped = 0;  ///< datagrams, before anybody looked at them (Bus::dropped)
  Rejects rejects;
};

/// A peer's ear on the plant: takes its STATEs in order, keeps to one session, notices END, STOP, signals
/// and silence. What controller and planner have in common.
class PlantLink {
 public:
  PlantLink(Bus& bus, const StopSwitch& stop, const PeerOptions& options);

  enum class Event : std::uint8_t {
    fresh,     ///< state() is of a tick not heard before
    repeated,  ///< the plant sent the latest state again: it has no answer
    other,     ///< something else was received
    nothing,   ///< nothing was, until the time given
    over,      ///< leave, see ending()
  };

  /// Waits for one message, until a time. Throws RunFault `lost_peer` where the plant is silent for too long
  /// and `config_mismatch` where it was started with something else.
  Event next(Instant until = Instant::max());

  const state_t& state() const { return state_; }
  std::int64_t latest() const { return report.latest; }        ///< tick of state(), -1 before any
  bool first_of_session() const { return first_of_session_; }  ///< state() is the first of its session
  std::int64_t session() const { return session_.current(); }
  /// Of a COMMAND or REFERENCE.
  Header answer_header(std::int64_t tick, std::int64_t utime) const;
  Ending ending() const { return ending_; }

  /// Checks session and config of a message by another peer; the cause where it must be dropped.
  std::optional<Reject> check_origin(std::int64_t session, std::int64_t config) const;

  PeerReport report;

 private:
  Event silence();
  Event judge();
  [[noreturn]] void refuse_config() const;
  std::optional<Reject> check_state(const Received& message, Instant at);
  void on_state(const Received& message);
  void on_control(const Received& message);
  void on_stop(Bytes) { stop_heard_ = true; }

  Bus& bus_;
  const StopSwitch& stop_;
  PeerOptions options_;
  const std::string state_channel_;
  SessionFollower session_;
  Inbox<state_t> inbox_;
  Inbox<sim_control_t> control_inbox_;
  state_t state_;

  Instant deadline_;
  Event heard_ = Event::other;
  bool first_of_session_ = false;
  ConfigAgreement agreement_;
  Dropped dropped_;  ///< STATEs since the last that was taken
  bool end_heard_ = false, stop_heard_ = false;
  Ending ending_ = Ending::finished;
};

}  // namespace mixloop
