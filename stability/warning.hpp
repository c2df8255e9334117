// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "loop/experiment.hpp"

namespace mixloop {

/// What a user should know of an experiment's stability before it runs: a sentence each where the sampled
/// loop is unstable at an instant of the path, or would be with a tick a tenth longer or a delay a tenth of a
/// tick longer. Empty where it is far from its limits. Takes some milliseconds.
std::vector<std::string> stability_warnings(const Experiment& experiment, const Plan& plan);

}  // namespace mixloop
