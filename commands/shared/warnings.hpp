// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop {

/// What is doubtful about an experiment though it can be run, a sentence each: its scene's numbers, its
/// stability. Said on stderr unless `quiet`; results keep it as `warnings`.
std::vector<std::string> warnings_of(const Experiment& experiment, const Plan& plan, bool quiet);

/// Says them on stderr unless `quiet`.
void say(const std::vector<std::string>& warnings, bool quiet);

}  // namespace mixloop
