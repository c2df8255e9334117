// SPDX-License-Identifier: MIT
// What closures are solved for by corrections, on its way.
#pragma once

#include "dynamics/symbolic/block_solver.hpp"

namespace mixloop {

/// An unknown on its way: its value and, of an angle, its cosine and sine.
struct Iterate {
  Expression value, cosine, sine;
};

/// Where an unknown starts.
Iterate iterate_from_start(const Scene& scene, int coordinate);

/// Corrected and held. An angle is turned by `by` as far as a rotation by 2 atan(by/2) is: on the unit circle,
/// and the same to second order.
Iterate corrected(const Iterate& at, const Expression& by, bool turns, unsigned tag);

/// What is left of the unknown `coordinate` when it has been corrected.
void add_to(SolvedBlock& solved, const Scene& scene, int coordinate, const Iterate& at);

}  // namespace mixloop
