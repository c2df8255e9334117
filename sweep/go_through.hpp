// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "sweep/crew.hpp"
#include "sweep/folder.hpp"
#include "sweep/journal.hpp"
#include "sweep/kernel/closed_loops.hpp"
#include "sweep/leading.hpp"

namespace mixloop {

/// How far a sweep is.
struct SweepProgress {
  std::int64_t done = 0, of = 0;  ///< runs, of this part
  double rate = 0;                ///< runs a second, since it began
};

/// By whom, and with whom, runs are gone through.
struct Going {
  Engine engine = LaneEngine();
  int threads = 1;
  Peers* peers = nullptr;                      ///< other processes that this one leads
  std::chrono::milliseconds patience{10'000};  ///< with them
  std::function<bool()> goes_on = [] { return true; };
  std::function<void(const SweepProgress&)> told = [](const SweepProgress&) {};  ///< several times a second
  std::function<void(const std::string&)> said = [](const std::string&) {};
};

/// Goes through the runs of a part that no journal of the folder has yet, and keeps them in the part's
/// journal. Ends early where `goes_on` says so, once what is begun is kept. Throws RunFault("cannot_write"),
/// what is kept being whole.
void go_through(const Sweep& sweep, const SweepFolder& folder, const Part& part, const Going& how);

}  // namespace mixloop
