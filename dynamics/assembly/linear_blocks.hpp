// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/assembly/closing.hpp"

namespace mixloop {

/// Of each block whether its unknowns follow linearly from the independent coordinates, which is guessed from
/// home and proven by substitution at other poses and, for what is a parameter, other values. These unknowns
/// have that formula in the scene afterwards; slopes and constants that are rational numbers (of a turn) to
/// round-off are these.
std::vector<bool> linear_blocks(Scene& scene, Closing& closing, const std::vector<Closing::Part>& blocks,
                                const Vector& x);

}  // namespace mixloop
