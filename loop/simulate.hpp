// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "loop/experiment.hpp"
#include "loop/recorder.hpp"

namespace mixloop {

/// The closed loop in one process, as fast as it goes: the same plant, controller and plan that the three
/// processes run over the bus, so the same bytes. `go_on(k)` is asked at every tick; false interrupts.
void simulate(const Experiment& experiment, const Plan& plan, Recorder& recorder,
              const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
