// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/iterate.hpp"

namespace mixloop {
namespace {

using E = Expression;

// The length is brought back to 1, which rounding would leave tick by tick.
Iterate turned(const Iterate& at, const E& by) {
  const E half = E(0.5) * by, square = half * half;
  const E scale = E(1.0) / (E(1.0) + square);
  const E c = (E(1.0) - square) * scale, s = by * scale;
  const E cosine = at.cosine * c - at.sine * s, sine = at.sine * c + at.cosine * s;
  const E longer = E(1.5) - E(0.5) * (cosine * cosine + sine * sine);
  // 2 atan(x/2) = x - x^3/12 + x^5/80 - ...; corrections are small.
  const E angle = by * (E(1.0) - square * (E(1.0 / 3) - square * (E(1.0 / 5) - square * E(1.0 / 7))));
  return {at.value + angle, cosine * longer, sine * longer};
}

}  // namespace

Iterate iterate_from_start(const Scene& scene, int coordinate) {
  const ClosureStart start = start_of(scene, coordinate);
  return {start.value, start.cosine, start.sine};
}

Iterate corrected(const Iterate& at, const E& by, bool turns, unsigned tag) {
  if (!turns) return {E::held(at.value + by, tag), at.cosine, at.sine};
  Iterate to = turned(at, by);
  to = {E::held(to.value, tag), E::held(to.cosine, tag), E::held(to.sine, tag)};
  recording_graph().set_pair(to.value.node(), to.cosine.node(), to.sine.node());
  return to;
}

void add_to(SolvedBlock& solved, const Scene& scene, int coordinate, const Iterate& at) {
  if (scene.turns(coordinate))
    solved.angles.push_back({{{coordinate, 1}}, at.value, at.cosine, at.sine});
  else
    solved.lengths.push_back({coordinate, at.value});
}

}  // namespace mixloop
