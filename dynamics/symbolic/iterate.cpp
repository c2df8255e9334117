// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/iterate.hpp"

namespace mixloop {
namespace {

using E = Expression;

struct Turned {
  E cosine, sine, angle;
};

Turned turned(const Iterate& at, const E& c, const E& s) {
  return {at.cosine * c - at.sine * s, at.sine * c + at.cosine * s, 0.0};
}

Turned turned(const Iterate& at, const E& by, Turning how) {
  if (how == Turning::least) {
    Turned to = turned(at, E(1.0), by);
    to.angle = by;
    return to;
  }
  if (how == Turning::small) {
    const E square = by * by;
    Turned to = turned(at, E(1.0) - E(0.5) * square, by);
    to.angle = by + square * by * E(1.0 / 6);
    return to;
  }
  const E half = E(0.5) * by, square = half * half;
  const E scale = E(1.0) / (E(1.0) + square);
  const E c = (E(1.0) - square) * scale;
  Turned to = turned(at, c, by * scale);
  const E longer =
      how == Turning::exact ? E(1.0) : E(1.5) - E(0.5) * (to.cosine * to.cosine + to.sine * to.sine);
  // 2 atan(x/2) = x - x^3/12 + x^5/80 - ...; corrections are small.
  to.angle = by * (E(1.0) - square * (E(1.0 / 3) - square * (E(1.0 / 5) - square * E(1.0 / 7))));
  to.cosine = to.cosine * longer, to.sine = to.sine * longer;
  return to;
}

Iterate held(const Iterate& angle, unsigned tag) {
  const Iterate held{E::held(angle.value, tag), E::held(angle.cosine, tag), E::held(angle.sine, tag)};
  recording_graph().set_pair(held.value.node(), held.cosine.node(), held.sine.node());
  return held;
}

}  // namespace

Iterate iterate_from_start(const Scene& scene, int coordinate) {
  const ClosureStart start = start_of(scene, coordinate);
  return {start.value, start.cosine, start.sine};
}

Iterate iterate_on_the_circle(const Scene& scene, int coordinate, unsigned tag) {
  const Iterate start = iterate_from_start(scene, coordinate);
  if (!scene.turns(coordinate)) return start;
  // Apart from the pair that they are, of which the graph knows that it is on the circle.
  const E c = E::held(start.cosine, tag), s = E::held(start.sine, tag);
  const E scale = E(1.0) / sqrt(c * c + s * s);
  return held({start.value, c * scale, s * scale}, tag);
}

Iterate corrected(const Iterate& at, const E& by, bool turns, unsigned tag, Turning how) {
  if (!turns) return {E::held(at.value + by, tag), at.cosine, at.sine};
  const Turned to = turned(at, by, how);
  return held({at.value + to.angle, to.cosine, to.sine}, tag);
}

void add_to(SolvedBlock& solved, const Scene& scene, int coordinate, const Iterate& at) {
  if (scene.turns(coordinate))
    solved.angles.push_back({{{coordinate, 1}}, at.value, at.cosine, at.sine});
  else
    solved.lengths.push_back({coordinate, at.value});
}

}  // namespace mixloop
