// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "loop/recorded_plant.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/protocol/plant_report.hpp"

namespace mixloop {

/// Hears the operator's FAULTs of a session, for the tick in hand to take, and answers each once: it is
/// taken, refused (stderr says why), or not allowed. One that its sender repeats, or that overtook a later
/// one of the same sender's, is left alone; what is damaged, of another session or for another experiment is
/// counted among the report's rejects.
class FaultEar {
 public:
  /// What is passed must outlive it. Unless `allowed` it takes none.
  FaultEar(Bus& bus, const RecordedPlant& run, bool allowed, std::int64_t config, PlantReport& report);
  ~FaultEar() { bus_.unsubscribe(channel_); }
  FaultEar(const FaultEar&) = delete;
  FaultEar& operator=(const FaultEar&) = delete;

  std::span<const Fault> heard() const { return heard_; }  ///< since forget()
  /// The tick in hand has taken them.
  void forget() { heard_.clear(); }

 private:
  void on_fault(const Received& message);
  bool is_news(Endpoint sender, std::int64_t count);
  Fault fault_in(const fault_t& message) const;
  void take(const fault_t& message);
  bool healed_already(const Fault& fault) const;
  void answer(std::int8_t what);

  Bus& bus_;
  const std::string channel_;
  const RecordedPlant& run_;
  const bool allowed_;
  const std::int64_t config_;
  PlantReport& report_;
  Inbox<fault_t> inbox_;
  Outbox<fault_t> answer_;
  /// The latest of each sender's own count, of the last so many senders: `mixloop control` is a new one each
  /// time.
  struct Count {
    Endpoint sender;
    std::int64_t latest = -1;
  };
  std::array<Count, 64> counts_{};
  std::size_t senders_ = 0;
  std::vector<Fault> heard_;
};

}  // namespace mixloop
