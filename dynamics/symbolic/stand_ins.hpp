// SPDX-License-Identifier: MIT
// Rows as polynomials in what is not solved yet: places in the graph that stand for it, by which rows are
// differentiated.
#pragma once

#include <vector>

#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/derivative.hpp"

namespace mixloop {

/// A place that stands for something of a block, up to four of it.
inline Expression stand_in(int block, std::size_t index) {
  return Expression::held(
      Expression::input(Block::start, kNoStart + 4 * static_cast<std::size_t>(block) + index), 0);
}

inline bool depends(const Expression& x, const Expression& on) {
  if (x.is_number()) return false;
  const Graph& graph = recording_graph();
  return on.node() <= x.node() && needed(graph, std::vector{x.node()})[on.node()];
}

/// dx / d by.
inline Expression slope(const Expression& x, const Expression& by) {
  if (!depends(x, by)) return 0.0;
  Graph& graph = recording_graph();
  return Expression::of(
      tangents(graph, std::vector{x.node()}, std::vector{by.node()}, std::vector{graph.one()})[0]);
}

/// x where these parts are zero.
inline Expression without(const Expression& x, const std::vector<Expression>& parts) {
  if (x.is_number()) return x;
  Graph& graph = recording_graph();
  std::vector<NodeId> nodes, zeros(parts.size(), graph.zero());
  for (const Expression& part : parts) nodes.push_back(part.node());
  return Expression::of(substituted(graph, std::vector{x.node()}, nodes, zeros)[0]);
}

}  // namespace mixloop
