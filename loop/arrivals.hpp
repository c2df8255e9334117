// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "loop/recorded_plant.hpp"

namespace mixloop {

/// The run in real time that had these arrivals, in one process and at once: the same bytes, where the
/// commands were the experiment's own controller's.
void simulate_arrivals(RecordedPlant& run, const Arrivals& arrivals,
                       const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
