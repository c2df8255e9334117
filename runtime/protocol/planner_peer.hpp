// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "runtime/protocol/plant_link.hpp"

namespace mixloop {

/// The plan as the peer calls it.
struct PlannerSide {
  /// Fills all of the message but its header. Must give the same for the same tick, for any tick from 0 on
  /// (past the end: the end). Must not allocate, lock or throw.
  std::function<void(std::int64_t tick, reference_t& message)> refer;
  /// Optional: called with the first STATE of every session, before its references. May allocate and throw.
  std::function<void(const state_t& first)> begin;
};

/// The planner's side of the bus: one tick ahead of the plant. STATE(k) is answered by REFERENCE(k + 1), and
/// by REFERENCE(k) before it where k is 0, repeated or skipped.
///
/// After start-up a tick costs no allocation, lock or throw of ours.
class PlannerPeer {
 public:
  PlannerPeer(Bus& bus, const StopSwitch& stop, const PeerOptions& options, PlannerSide side);

  /// Runs until the plant says END, somebody says STOP, or the switch is turned. Throws RunFault `lost_peer`
  /// or `config_mismatch`.
  Ending run();

  const PeerReport& report() const { return link_.report; }

 private:
  void publish(std::int64_t tick);

  Bus& bus_;
  PeerOptions options_;
  PlannerSide side_;
  PlantLink link_;
  Outbox<reference_t> reference_;
  const std::string reference_channel_;
  std::int64_t sent_ = -1;  // the latest tick of this session whose reference went out
};

}  // namespace mixloop
