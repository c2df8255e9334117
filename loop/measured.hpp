// SPDX-License-Identifier: MIT
#pragma once

#include "loop/experiment.hpp"

namespace mixloop {

/// The plant's independent coordinates that are measured, the motors first: what STATE counts.
std::vector<int> measured_coordinates(const Experiment& experiment);

/// Of each independent coordinate of the controller's scene, which of the plant's it is. A controller may
/// know fewer free ones than the plant has.
std::vector<int> model_coordinates(const Experiment& experiment);

/// Of each coordinate that the control law takes its place in what is measured; -1 where it isn't.
std::vector<int> seen_coordinates(const Experiment& experiment);

/// Throws InputError where the controller's scene has not the plant's motors, or free coordinates that the
/// plant hasn't. `place`: of the key that names it.
void require_same_motors(const Scene& controllers, const Scene& plants, const Place& place);

/// Throws InputError where the law takes what isn't measured. `controller`: its mapping.
void require_measured(const Experiment& experiment, const NodePtr& controller);

}  // namespace mixloop
