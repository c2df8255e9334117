// SPDX-License-Identifier: MIT
// Rows as polynomials in what is not solved yet: places in the graph that stand for it, by which rows are
// differentiated.
#pragma once

#include <vector>

#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/derivative.hpp"

namespace mixloop {

/// Places that stand for what is not solved yet, while rows are looked at: no angle's sine is made of theirs
/// after that.
class StandIns {
 public:
  explicit StandIns(int block) : block_(block) {}
  StandIns(const StandIns&) = delete;
  StandIns& operator=(const StandIns&) = delete;
  ~StandIns() { forget(); }

  /// One more, of up to four.
  Expression next() {
    const std::size_t index = kNoStart + 4 * static_cast<std::size_t>(block_) + places_.size();
    const Expression place = Expression::held(Expression::input(Block::start, index), 0);
    places_.push_back(place.node());
    return place;
  }
  void forget() { recording_graph().forget_pairs_through(places_); }

 private:
  int block_;
  std::vector<NodeId> places_;
};

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
