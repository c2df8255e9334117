// SPDX-License-Identifier: MIT
// A block of closures by Newton's method, unrolled.
#include "dynamics/symbolic/iterate.hpp"

namespace mixloop {

using E = Expression;

SolvedBlock solve_by_newton(const Model<E>& model, int b, AlongOnGraph& along) {
  const Scene& scene = *model.scene;
  const Scene::Block& block = scene.blocks[static_cast<std::size_t>(b)];
  std::vector<Iterate> at;
  for (int j : block.unknowns) at.push_back(iterate_from_start(scene, j));
  SolvedBlock solved;
  for (int k = 0; k < ClosedChains::kCorrections; ++k) {
    for (std::size_t i = 0; i < at.size(); ++i) along.x(block.unknowns[i]) = at[i].value;
    ExpressionMatrix slopes;
    ExpressionVector values;
    along.linearise(block, slopes, values);
    const ExpressionVector correction = SmallSystem<E>(slopes).solve(-values);
    solved.corrections.assign(correction.begin(), correction.end());
    for (std::size_t i = 0; i < at.size(); ++i)
      at[i] = corrected(at[i], correction[static_cast<Eigen::Index>(i)], scene.turns(block.unknowns[i]),
                        1 + static_cast<unsigned>(8 * b + k));
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    solved.x.push_back(at[i].value);
    add_to(solved, scene, block.unknowns[i], at[i]);
  }
  return solved;
}

}  // namespace mixloop
