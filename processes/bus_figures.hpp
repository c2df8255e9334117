// SPDX-License-Identifier: MIT
#pragma once

#include "loop/result.hpp"
#include "plant/deadline_plant.hpp"
#include "runtime/protocol/plant_report.hpp"

namespace mixloop {

/// What the bus adds to the result of a plant's session.
BusFigures bus_figures(const PlantReport& report);

/// What it adds to that in real time.
void add_deadlines(BusFigures& figures, const PlantReport& report, const DeadlinePlant& plant,
                   SafeState safe_state);

}  // namespace mixloop
