// SPDX-License-Identifier: MIT
#pragma once

#include "loop/result.hpp"
#include "notation/errors.hpp"
#include "runtime/bus/bus.hpp"

namespace mixloop {

/// Judges a run of processes that somebody else started, by what their STATEs and COMMANDs say: the same
/// measures, but of what was heard (`missing_ticks` says how much was not; then there is no
/// trajectory_sha256). Throws RunFault("lost_peer") when no plant is heard for `first_wait`, or nothing new
/// of it for `patience`.
Result attached(const Experiment& experiment, const BusOptions& options, nanoseconds first_wait,
                nanoseconds patience, const StopSwitch& stop);

/// For what listens to processes that somebody else started: there are none, and what to do about it.
RunFault no_plant_heard(const Bus& bus, const std::string& which = "");

}  // namespace mixloop
