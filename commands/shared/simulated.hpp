// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "loop/result.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// Runs an experiment in this process and gives its result; keeps it in the folder `out` unless that is
/// empty. Warnings are said on stderr unless `quiet`. `ages`: the file of a run in real time whose commands
/// arrive as they did then; empty: they all do at once.
Result simulated(Experiment experiment, const std::string& out, const StopSwitch& stop, bool quiet,
                 const std::string& ages = {});

}  // namespace mixloop
