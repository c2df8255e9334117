// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "dynamics/procedure/workspace.hpp"
#include "dynamics/symbolic/planar_loop.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

/// How a block of coordinates is solved in a program.
enum class BlockSolution : std::uint8_t {
  dyad,    ///< two links between known points or lines: by a square root
  newton,  ///< corrections from a start
};
constexpr std::string_view name_of(BlockSolution how) {
  return how == BlockSolution::dyad ? "closed form" : "Newton";
}

/// Solves a scene's closures on the graph, for a tracer's workspace. What is solved are nodes that nothing is
/// differentiated or simplified through (Graph::held), angles with their cosines and sines; no sine of a
/// solved angle is taken.
class ClosedChains {
 public:
  static constexpr int kCorrections = 2;  ///< by Newton's method, in one evaluation

  explicit ClosedChains(TracedInputs in) : in_(std::move(in)) {}

  /// As Workspace::solve, where the inputs are.
  void solve(const Model<Expression>& model, Workspace<Expression>& ws);

  /// As Tracer::cuts, from the coordinates' C.
  std::vector<Cut> cuts(const Workspace<Expression>& ws) const;
  /// Of all blocks that Newton's method solves, the last corrections, rad or m.
  const std::vector<Expression>& corrections() const { return corrections_; }
  /// Of each block.
  const std::vector<BlockSolution>& solutions() const { return how_; }

  /// A solved angle, a sum of coordinates, with its pair.
  struct Angle {
    WholeSum of;
    Expression angle, cosine, sine;
  };
  struct Length {
    int of;
    Expression length;
  };

 private:
  const TracedInputs in_;
  std::vector<BlockSolution> how_;
  std::vector<Expression> corrections_;
  std::vector<Angle> angles_;
  std::vector<Length> lengths_;
};

}  // namespace mixloop
