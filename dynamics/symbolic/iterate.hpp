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
/// The same on the unit circle, however far off it was.
Iterate iterate_on_the_circle(const Scene& scene, int coordinate, unsigned tag);

/// How an angle's cosine and sine are turned by a correction. In a chain of corrections, each the square of
/// the one before, the later need less: what they are off the unit circle is below round-off where the last
/// is below 1e-9, and elsewhere what follows starts on the circle again.
enum class Turning {
  brought_back,  ///< by 2 atan(by/2), and what rounding leaves of the length is brought back to 1
  exact,         ///< by 2 atan(by/2)
  small,         ///< by atan(by / (1 - by^2/2)): the length is off by by^4/8
  least,         ///< by atan(by): the length is off by by^2/2
};

/// Corrected and held.
Iterate corrected(const Iterate& at, const Expression& by, bool turns, unsigned tag,
                  Turning how = Turning::brought_back);

/// What is left of the unknown `coordinate` when it has been corrected.
void add_to(SolvedBlock& solved, const Scene& scene, int coordinate, const Iterate& at);

}  // namespace mixloop
