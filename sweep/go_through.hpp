// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "sweep/crew.hpp"
#include "sweep/folder.hpp"
#include "sweep/journal.hpp"

namespace mixloop {

/// How far a sweep is.
struct SweepProgress {
  std::int64_t done = 0, of = 0;  ///< runs, of this process' part
  double rate = 0;                ///< runs a second, since it began
};

/// Goes through the runs of a part that no journal of the folder has yet, `threads` at a time, and keeps them in
/// the part's journal. Ends early where `goes_on` says so, once what is begun is kept. `told` hears how far it is,
/// several times a second. Throws RunFault("cannot_write"), what is kept being whole.
void go_through(const Sweep& sweep, const SweepFolder& folder, const Part& part, const Engine& engine, int threads,
                const std::function<bool()>& goes_on, const std::function<void(const SweepProgress&)>& told);

}  // namespace mixloop
