// SPDX-License-Identifier: MIT
#pragma once

#include "processes/bus_line.hpp"
#include "runtime/protocol/plant_options.hpp"

namespace mixloop {

/// The command line of mixloop-plant.
struct PlantLine : PeerLine {
  std::string speed;  ///< empty: max in lockstep, 1 in real time
  std::string out;
  bool paused = false;
  bool truth = false;
  bool hold = false;
  bool allow_faults = false;  ///< obey FAULT
  int report_fd = -1;
};

/// The main function of mixloop-plant: reads its line, runs it, gives its exit status.
int plant_main(int argc, char** argv, int (*run)(const PlantLine&));

/// What it tells the plant's runner of an experiment.
PlantOptions plant_options(const PlantLine& line, const Experiment& experiment, std::int64_t last_tick,
                           std::int64_t session);

}  // namespace mixloop
