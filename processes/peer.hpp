// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"
#include "processes/bus_line.hpp"
#include "runtime/protocol/plant_link.hpp"

namespace mixloop {

/// What controller and planner tell their peer of the bus.
PeerOptions peer_options(const PeerLine& line, const Experiment& experiment, std::int64_t last_tick,
                         const char* program);

/// How a controller or planner says that it leaves; its exit status.
int ended(const char* program, Ending ending, const PeerReport& report, const StopSwitch& stop);

/// The main function of a controller or planner: reads its line, runs it, gives its exit status.
int peer_main(int argc, char** argv, const char* description, const char* footer,
              int (*run)(const PeerLine&));

}  // namespace mixloop
