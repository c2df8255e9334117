// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/bus/bus.hpp"
#include "runtime/clock/clock.hpp"
#include "runtime/clock/stop_switch.hpp"
#include "runtime/protocol/conductor.hpp"
#include "runtime/protocol/config_agreement.hpp"
#include "runtime/protocol/dropped.hpp"
#include "runtime/protocol/ending.hpp"
#include "runtime/protocol/plant_options.hpp"
#include "runtime/protocol/plant_side.hpp"
#include "runtime/protocol/timing_sender.hpp"

namespace mixloop {

/// The plant's end of the bus, whichever loop drives it: publishes STATE, TRUTH, TIMING and END, takes
/// COMMANDs of its session, hears stops and the operator, keeps the pace.
class PlantPort {
 public:
  /// Why a wait is over.
  enum class Answer : std::uint8_t { command, due, interrupted, stopped, reset };

  PlantPort(Bus& bus, const StopSwitch& stop, const PlantOptions& options, PlantSide& plant,
            std::int32_t state_flags, nanoseconds slack);
  ~PlantPort();
  PlantPort(const PlantPort&) = delete;
  PlantPort& operator=(const PlantPort&) = delete;

  /// False where the sensors aren't finite: that tick must not reach the bus. `flags` beside those of all.
  bool publish_state(std::int64_t tick, std::int32_t flags = 0);
  void publish_truth(std::int64_t tick, std::int32_t flags = 0);
  /// TIMING, where it is due, as during every wait that repeats the STATE; `deadlines` is what real time
  /// adds.
  void publish_timing(const DeadlineCounts& deadlines);
  /// Says that it is over.
  void send_end(Ending ending);
  /// Says that the next session of this plant is `next`.
  void send_reset(std::int64_t next);

  /// Takes only commands of ticks from `oldest` to the latest STATE's.
  void want_from(std::int64_t oldest) { oldest_ = oldest; }
  const command_t& command() const { return inbox_.message; }
  std::int64_t tick() const { return tick_; }
  Instant sent() const { return sent_; }  ///< when the latest STATE was first sent

  /// Waits for the command of the tick, STATE again and again where none comes. Throws RunFault `lost_peer`,
  /// naming the channel that is silent, or `config_mismatch`, naming what differs.
  Answer wait_for_command();
  /// Waits for any command that is wanted, until `due`.
  Answer wait_until(Instant due);
  /// Waits until `tick` is due (not at all where it goes as fast as it can), or while the operator holds it.
  Answer wait_for_due(std::int64_t tick);

  /// Tick 0 begins.
  void start(Instant at) { pacer_.start(at); }
  const Pacer& pacer() const { return pacer_; }
  nanoseconds last_late() const { return last_late_; }  ///< how late the last wait_for_due was over

  PlantReport report;

 private:
  Answer asked() const;  ///< `due` where nothing is
  Answer wait_while_held();
  Answer began(std::int64_t tick);
  void send_repeatedly();
  void listen_for_planner();
  void listen_for_plants();
  void stop_listening();
  void require_agreement() const;
  [[noreturn]] void refuse_config() const;
  std::optional<Reject> check_command(const Received& message, Instant at);
  [[noreturn]] void lost_peer(nanoseconds waited) const;

  void on_command(const Received& message);
  void on_state(const Received& message);
  void on_control(Bytes bytes);
  void on_stop(Bytes) { stop_heard_ = true; }
  void on_reference(Bytes) { planner_heard_ = true; }

  Bus& bus_;
  const StopSwitch& stop_;
  PlantOptions options_;
  PlantSide& plant_;
  std::int32_t state_flags_;
  Pacer pacer_;
  Conductor conductor_;

  Outbox<state_t> state_;
  Outbox<truth_t> truth_;
  Outbox<sim_control_t> control_;
  TimingSender timing_;
  Inbox<command_t> inbox_;
  const std::string state_channel_, truth_channel_, control_channel_, command_channel_;

  std::int64_t tick_ = 0;    // of the latest STATE
  std::int64_t oldest_ = 0;  // whose command is still wanted
  Instant sent_{0};
  nanoseconds last_late_{0};
  bool command_heard_ = false;  // inbox_.message is one that is wanted
  bool stop_heard_ = false;
  bool listens_for_planner_ = false, listens_for_plants_ = false;
  bool planner_heard_ = false;
  std::string other_plant_;  // in words
  ConfigAgreement agreement_;
  Dropped dropped_;  // COMMANDs since the latest STATE was first sent
  SoleSender controller_;
  std::optional<std::int64_t> taken_;  // tick of the command taken last, but for a safe one
  bool speed_told_ = false;
  DeadlineCounts deadlines_;
};

}  // namespace mixloop
