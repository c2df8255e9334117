// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// One value a motor, of dimension `rotary` for rotary motors and `linear` for linear ones. Throws
/// InputError.
std::vector<double> read_motor_values(const NodePtr& node, const Scene& scene, const Dimension& rotary,
                                      const Dimension& linear, const char* what);

}  // namespace mixloop
