// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/protocol/config_agreement.hpp"
#include "runtime/protocol/plant_link.hpp"

namespace mixloop {

/// The control law as the peer calls it.
struct ControllerSide {
  /// The motor torques for a tick, from its state and its own reference, and command_t's flags. `ahead`: 0,
  /// or the ticks by which the reference is too old and to be extrapolated. Must not allocate, lock or throw.
  std::function<std::int32_t(const state_t& state, const reference_t& reference, std::int64_t ahead,
                             std::span<double> tau)>
      compute;
  /// Optional: a safe command where there is no state or reference to go by; zero torque without it. Must
  /// leave no trace in the law: it isn't known whether the plant takes it.
  std::function<void(std::span<double> tau)> safe;
  /// Optional: called with the first STATE of every session, before its compute; forgets what was. May
  /// allocate and throw.
  std::function<void(const state_t& first)> begin;
  /// Whether the law keeps something from tick to tick: then it can't join a session late.
  bool has_memory = false;
};

/// The controller's side of the bus: answers every STATE with the COMMAND that its law gives for it and for
/// the REFERENCE of the same tick, whichever comes first; never uses another tick's. A repeated STATE is
/// answered by the same bytes, an older one is dropped. Where there are no references (PeerOptions), a STATE
/// is answered at once, and the law is given a blank one of its tick.
///
/// Where the plant keeps real time, only the latest STATE is answered. A REFERENCE that isn't there after a
/// quarter of a tick is extrapolated from the last one, for at most `max_missed` ticks; after that the answer
/// is a safe command. One more is sent after as many ticks without a STATE, and on a STOP. Tick 0 waits for
/// its reference.
///
/// After start-up a tick costs no allocation, lock or throw of ours.
class ControllerPeer {
 public:
  ControllerPeer(Bus& bus, const StopSwitch& stop, const PeerOptions& options, ControllerSide side);

  /// Runs until the plant says END, somebody says STOP, or the switch is turned. Throws RunFault `lost_peer`
  /// (no STATE, or no REFERENCE for it, for too long), `config_mismatch`, `joined_late` (a law with memory),
  /// `not_finite` (the law gave no number: nothing of that tick is sent).
  Ending run();

  const PeerReport& report() const { return link_.report; }

 private:
  static constexpr std::int64_t kAhead = 64;  // references of this many ticks are kept

  struct Kept {
    std::int64_t tick;
    reference_t message;
  };
  Kept& kept(std::int64_t tick) { return ring_[static_cast<std::size_t>(tick % kAhead)]; }

  bool in_real_time() const { return (link_.state().flags & state_t::FLAG_REAL_TIME) != 0; }
  /// Nothing moves before all are there.
  bool at_the_gate() const { return link_.latest() == 0 && answered_ < 0; }
  nanoseconds ticks(double number) const;
  void begin_session();
  void answer_if_ready();
  void answer_without_reference(std::int64_t tick);
  void answer(const reference_t& reference);
  Instant next_look() const;
  void attend_to_time();
  const reference_t* newest_before(std::int64_t tick) const;
  void answer_safely();
  void send_safe_afterwards(std::int32_t flags);
  void fill_safe(command_t& message, std::int32_t flags) const;
  void repeat();
  void require_planner() const;
  [[noreturn]] void lost_planner() const;
  void on_reference(const Received& message);
  std::optional<Reject> check_reference(const Received& message, Instant at);

  Bus& bus_;
  PeerOptions options_;
  ControllerSide side_;
  PlantLink link_;
  Inbox<reference_t> inbox_;
  Outbox<command_t> command_;  // the answer to the latest tick that has one
  Outbox<command_t> safe_;     // what is said beside the answers
  const std::string reference_channel_, command_channel_;

  std::vector<Kept> ring_;
  reference_t none_;            // where there are no references: blank but for its tick
  std::int64_t answered_ = -1;  // the latest tick of this session that has its command
  Instant asked_{0};            // when the latest state came
  bool drained_ = true;         // real time: nothing newer waits to be read
  bool silence_answered_ = false;
  ConfigAgreement planner_agreement_;
  SoleSender planner_;
  Header taken_;     ///< of the REFERENCE taken last
  Dropped dropped_;  ///< REFERENCEs since the latest state came
};

}  // namespace mixloop
