// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loop/result.hpp"
#include "runtime/bus/bus.hpp"
#include "runtime/clock/stop_switch.hpp"

namespace mixloop {

/// How `mixloop run` launches the three processes.
struct Launch {
  std::string experiment;         ///< the file
  std::vector<std::string> sets;  ///< as given on the command line
  BusOptions bus;
  std::string speed;  ///< empty: max in lockstep, 1 in real time
  bool real_time = false;
  bool spin = false;  ///< plant and controller wait awake
  bool paused = false;
  std::string out;                   ///< empty: keep nothing
  std::vector<std::string> without;  ///< processes that a stranger provides
  std::vector<std::string> order = {"planner", "controller", "plant"};
  bool hold = false;
  bool truth = false;
  bool allow_faults = false;
  bool quiet = false;      ///< no progress, no notes
  double patience = 10;    ///< s
  double first_wait = 60;  ///< s, for all to be there
  Evaluation evaluation = Evaluation::machine_code;
};

/// Launches the processes that are not `without`, waits for their end and gives the plant's result. All of
/// them are gone when this returns or throws. Throws RunFault naming the process that failed, with its last
/// words, and InputError where the experiment is bad input or can't be run over the bus. `stop` ends the run
/// in order: the partial result is returned. With `hold`, `at_end` is called with the result when the path is
/// over.
Result launched(const Experiment& experiment, const Launch& launch, const StopSwitch& stop,
                const std::function<void(const Result&)>& at_end = {});

}  // namespace mixloop
