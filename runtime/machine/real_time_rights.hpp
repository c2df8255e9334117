// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mixloop {

/// What a process that keeps time asks of the machine; each is taken where it is allowed, and given back at
/// the end of the process.
struct RealTimeWishes {
  int priority = 80;  ///< SCHED_FIFO, of every thread there is now; 0: leave it
  int cpu = -1;       ///< to which all of them are bound; -1: to none
};

/// Locks and prefaults memory, raises the priority, binds to a core, holds /dev/cpu_dma_latency at 0.
/// To be called once all threads are there. Returns what is not allowed, a line each, with what that costs
/// and what mends it.
std::vector<std::string> take_real_time_rights(const RealTimeWishes& wishes);

}  // namespace mixloop
