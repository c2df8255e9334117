// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loop/recorder.hpp"

namespace mixloop {

/// Steps that are too coarse for the plant itself.
struct StepDoubt {
  std::string text;
  bool grows = false;  ///< by them a motion grows that doesn't
};

/// That of an experiment's plant along its path; nothing where its steps are fine enough, or where there is
/// none to look along.
std::optional<StepDoubt> step_doubt(const Experiment& experiment, const Plan& plan);

/// What is to be said of a run that is over and was not to be foreseen: steps too coarse for the states that
/// the plant really met; a local error beyond what `integrator: auto` was asked for; an angle that jumped; a
/// mass matrix that was singular where the run ended. Of a run that switches coordinates, jumps alone.
std::vector<std::string> review(const Experiment& experiment, const Plan& plan, const Recorder& record);

}  // namespace mixloop
