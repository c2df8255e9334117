// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"

namespace mixloop {

// What an experiment without a path has of its own, for its reader. All throw InputError at the entry.

/// Refuses what goes with a path alone, or without one alone. `controller`, `plant`: the entries; the second
/// may be null.
void check_motion(const Experiment& experiment, const NodePtr& controller, const NodePtr& plant);

/// Limits watch over a path and its plan: without one each is refused.
void refuse_limits(const Mapping& limits);

/// The drives' own servo takes the gains of the law; of one that has none, the safe state is zero torque or
/// the brake. `root`: the experiment.
void settle_safe_state(const Mapping& root, Experiment& experiment);

/// Where it starts that has no path (n): at `plant.initial`, or at home.
std::span<const double> start_of(const Experiment& experiment);

/// Its ticks, and the reference of all of them. Throws InputError("off_grid") as ticks_of does.
Plan plan_without_path(const Experiment& experiment);

}  // namespace mixloop
