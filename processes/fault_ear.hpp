// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/protocol/plant_report.hpp"

namespace mixloop {

/// Hears the operator's FAULTs of a session, for the tick in hand to take, and answers each once: it is
/// taken, refused (stderr says why), or not allowed. A repeated one is left alone; what is damaged or of
/// another session is counted among the report's rejects.
class FaultEar {
 public:
  /// What is passed must outlive it. Unless `allowed` it takes none.
  FaultEar(Bus& bus, const Experiment& experiment, bool allowed, PlantReport& report);
  ~FaultEar() { bus_.unsubscribe(channel_); }
  FaultEar(const FaultEar&) = delete;
  FaultEar& operator=(const FaultEar&) = delete;

  std::span<const Fault> heard() const { return heard_; }  ///< since forget()
  /// The tick in hand has taken them, but for so many.
  void forget(std::int64_t not_taken);

 private:
  void on_fault(Bytes bytes);
  Fault fault_in(const fault_t& message) const;
  void take(const fault_t& message);
  void answer(std::int8_t what);

  Bus& bus_;
  const std::string channel_;
  const Experiment& experiment_;
  const bool allowed_;
  PlantReport& report_;
  Inbox<fault_t> inbox_;
  Outbox<fault_t> answer_;
  std::int64_t count_ = -1;  ///< of the sender's own count, the latest
  std::vector<Fault> heard_;
};

}  // namespace mixloop
