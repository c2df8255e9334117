// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "runtime/bus/bus.hpp"
#include "runtime/clock/clock.hpp"

namespace mixloop {

enum class Fitness : std::uint8_t {
  good,
  fair,  ///< 1 kHz holds, with less margin than there could be
  bad,   ///< 1 kHz will not hold
};

/// One answer to "is this machine fit for 1 kHz?".
struct Finding {
  std::string what, value;
  Fitness verdict = Fitness::good;
  std::string mend;  ///< the command that mends it; empty where all is good
};

// What the machine allows.
Finding multicast_finding(const BusOptions& bus);
Finding receive_buffer_finding();
Finding priority_finding();       ///< tries SCHED_FIFO in a thread of its own
Finding locked_memory_finding();  ///< tries to lock 64 MB
Finding governor_finding();
Finding idle_latency_finding();  ///< /dev/cpu_dma_latency

// What it does; each is measured for about `span`.

/// Wake-ups from an absolute sleep every millisecond, as cyclictest measures them; at SCHED_FIFO where
/// allowed.
Finding wake_up_finding(nanoseconds span);
/// A message of STATE's size to another thread's connection and back, over the bus.
Finding round_trip_finding(const BusOptions& bus, nanoseconds span);
/// Who else publishes on the channels.
Finding publishers_finding(const BusOptions& bus, nanoseconds span);

}  // namespace mixloop
