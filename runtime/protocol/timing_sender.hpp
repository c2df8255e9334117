// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "runtime/bus/bus.hpp"
#include "runtime/protocol/plant_report.hpp"
#include "runtime/protocol/plant_side.hpp"

namespace mixloop {

/// Publishes TIMING five times a second, while the plant has nothing else to do. Allocates nothing after
/// construction.
class TimingSender {
 public:
  TimingSender(Bus& bus, const Header& header);

  /// Sends where it is time to, and says whether; `header` is the latest STATE's.
  bool send_where_due(Bus& bus, const Header& header, const PlantReport& report,
                      const DeadlineCounts& deadlines);

 private:
  std::string channel_;
  Outbox<timing_t> message_;
  Instant next_{0};
};

}  // namespace mixloop
