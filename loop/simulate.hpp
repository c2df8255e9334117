// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "loop/recorded_plant.hpp"

namespace mixloop {

/// Throws RunFault("not_at_start") where the robot stands too far from where a path starts.
void require_start(const GuardedController& controller, std::span<const double> psi, const Plan& plan);

/// The closed loop in one process, as fast as it goes: the same plant, controller and plan that the three
/// processes run over the bus, so the same bytes. `go_on(k)` is asked at every tick; false interrupts.
void simulate(RecordedPlant& run, const std::function<bool(std::int64_t k)>& go_on);

/// tau (n_u) for what is measured and desired.
using TorqueLaw = std::function<void(const Measurement&, const Reference&, std::span<double> tau)>;

/// The same with any law in the controller's place.
void simulate(RecordedPlant& run, const TorqueLaw& law, const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
