// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "loop/recorder.hpp"
#include "plant/arrivals.hpp"

namespace mixloop {

/// The run in real time that had these arrivals, in one process and at once: the same bytes, where the
/// commands were the experiment's own controller's.
void simulate_arrivals(const Experiment& experiment, const Plan& plan, const Arrivals& arrivals,
                       Recorder& recorder, const std::function<bool(std::int64_t k)>& go_on);

}  // namespace mixloop
