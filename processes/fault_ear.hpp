// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "plant/faults.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/protocol/plant_report.hpp"

namespace mixloop {

/// Hears the operator's FAULTs of a session, for the tick in hand to take. A repeated one is taken once; what
/// can't be is left alone, or counted among the report's rejects.
class FaultEar {
 public:
  FaultEar(Bus& bus, int n, PlantReport& report);
  ~FaultEar() { bus_.unsubscribe(channel_); }
  FaultEar(const FaultEar&) = delete;
  FaultEar& operator=(const FaultEar&) = delete;

  std::span<const Fault> heard() const { return heard_; }  ///< since forget()
  void forget() { heard_.clear(); }

 private:
  void on_fault(Bytes bytes);

  Bus& bus_;
  const std::string channel_;
  PlantReport& report_;
  Inbox<fault_t> inbox_;
  std::int64_t count_ = -1;  ///< of the sender's own count, the latest
  std::vector<Fault> heard_;
};

}  // namespace mixloop
