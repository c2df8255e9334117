// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "runtime/clock/stop_switch.hpp"
#include "sweep/folder.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/peers.hpp"
#include "sweep/statistics.hpp"

namespace mixloop {

/// How a sweep is gone through, and what is kept of it.
struct SweepOptions {
  std::string out;  ///< a folder; empty: nothing is kept
  int threads = 1;
  Part part;
  bool merges = false;     ///< what is kept is put together, and nothing run
  bool quiet = false;      ///< no word of how far it is
  Peers* peers = nullptr;  ///< processes that this one leads
  double patience = 10;    ///< s, with them
  LoopDevice device = LoopDevice::cpu;
};

/// A sweep that was gone through, or a part of it.
struct Swept {
  Statistics statistics;  ///< of the runs that are there
  std::int64_t runs = 0;  ///< of the sweep
  bool interrupted = false;
  double wall_time = 0;  ///< s
  std::vector<std::string> missed;
  int exit_status = 0;

  bool is_whole() const { return statistics.runs == runs; }
};

/// Goes through a sweep and keeps its table once all its runs are there. Throws InputError and RunFault.
Swept swept(const Sweep& sweep, const SweepOptions& options, const StopSwitch& stop);

/// The same as one result of a suite.
Result result_of(const Sweep& sweep, const Swept& swept);

/// What is told of it: to people, and as JSON.
std::string summary(const Sweep& sweep, const Swept& swept, const SweepOptions& options);
nlohmann::json json_of(const Sweep& sweep, const Swept& swept, const SweepOptions& options);

}  // namespace mixloop
