// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/assembly/closing.hpp"

namespace mixloop {

/// Puts the scene's formulas and the blocks that are not linear in order, into its steps and blocks.
void put_steps(Scene& scene, const Closing& closing, const std::vector<Closing::Part>& blocks,
               const std::vector<bool>& is_linear);

}  // namespace mixloop
