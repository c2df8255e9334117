// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "loop/experiment.hpp"
#include "runtime/stop_switch.hpp"

namespace mixloop {

/// Runs an experiment in this process and gives its result; keeps it in the folder `out` unless that is
/// empty. Warnings are said on stderr unless `quiet`.
nlohmann::json simulated(const Experiment& experiment, const std::string& out, const StopSwitch& stop,
                         bool quiet);

}  // namespace mixloop
