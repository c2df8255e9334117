// SPDX-License-Identifier: MIT
// A block of closures by Newton's method, unrolled.
#include "dynamics/symbolic/block_solver.hpp"

namespace mixloop {
namespace {

using E = Expression;

/// An unknown on its way.
struct Iterate {
  E value, cosine, sine;
};

/// Turned by `by`, as far as a rotation by 2 atan(by/2) is: on the unit circle, and the same to second order.
/// The length is brought back to 1, which rounding would leave tick by tick.
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

SolvedBlock solve_by_newton(const Model<E>& model, int b, AlongOnGraph& along) {
  const Scene& scene = *model.scene;
  const Scene::Block& block = scene.blocks[static_cast<std::size_t>(b)];
  std::vector<Iterate> at;
  for (int j : block.unknowns) {
    const ClosureStart start = start_of(scene, j);
    at.push_back({start.value, start.cosine, start.sine});
  }
  SolvedBlock solved;
  for (int k = 0; k < ClosedChains::kCorrections; ++k) {
    for (std::size_t i = 0; i < at.size(); ++i) along.x(block.unknowns[i]) = at[i].value;
    ExpressionMatrix slopes;
    ExpressionVector values;
    along.linearise(block, slopes, values);
    const ExpressionVector correction = SmallSystem<E>(slopes).solve(-values);
    solved.corrections.assign(correction.begin(), correction.end());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const int j = block.unknowns[i];
      const E& by = correction[static_cast<Eigen::Index>(i)];
      const unsigned tag = 1 + static_cast<unsigned>(8 * b + k);
      if (!scene.turns(j)) {
        at[i].value = E::held(at[i].value + by, tag);
        continue;
      }
      at[i] = turned(at[i], by);
      at[i] = {E::held(at[i].value, tag), E::held(at[i].cosine, tag), E::held(at[i].sine, tag)};
      recording_graph().set_pair(at[i].value.node(), at[i].cosine.node(), at[i].sine.node());
    }
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    const int j = block.unknowns[i];
    solved.x.push_back(at[i].value);
    if (scene.turns(j))
      solved.angles.push_back({{{j, 1}}, at[i].value, at[i].cosine, at[i].sine});
    else
      solved.lengths.push_back({j, at[i].value});
  }
  return solved;
}

}  // namespace mixloop
