// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loop/experiment.hpp"
#include "loop/measures.hpp"

namespace mixloop {

/// Exit status of a command, DESIGN: 0 held, 1 a bound missed, 2 bad input, 3 a fault at run time, 130
/// interrupted.
enum ExitStatus : int { kHeld = 0, kMissed = 1, kBadInput = 2, kRunFault = 3, kInterrupted = 130 };

/// A run judged against what its experiment expects.
struct Verdict {
  std::string word;                 ///< "held", "missed", "diverged", "safe_state" or "interrupted"
  std::vector<std::string> missed;  ///< each bound that was missed, in words
  int exit_status = kHeld;          ///< of `simulate` and `run`: divergence is 3, expected or not
};
Verdict judge(const Experiment& experiment, const Measures& measures);

/// The JSON of a run: measures, verdict, and how it came about (route, evaluation, parameters, versions).
nlohmann::json result_json(const Experiment& experiment, const Measures& measures, const std::string& route,
                           double wall_time);

/// The summary that a person reads.
std::string summary(const Experiment& experiment, const nlohmann::json& result);

}  // namespace mixloop
