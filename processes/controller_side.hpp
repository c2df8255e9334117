// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"
#include "runtime/protocol/controller_peer.hpp"

namespace mixloop {

/// An experiment's controller as the bus calls it. What is passed must outlive it.
ControllerSide controller_side(GuardedController& controller, const Experiment& experiment, const Plan& plan);

}  // namespace mixloop
