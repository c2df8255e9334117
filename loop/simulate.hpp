// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "loop/recorded_plant.hpp"

namespace mixloop {

/// Throws RunFault("not_at_start") where the robot stands too far from where the references start.
void require_start(const GuardedController& controller, std::span<const double> psi, const Plan& plan);

/// The closed loop in one process, as fast as it goes: the same plant, controller and plan that the three
/// processes run over the bus, so the same bytes. `go_on(k)` is asked at every tick; false interrupts.
void simulate(RecordedPlant& run, const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
