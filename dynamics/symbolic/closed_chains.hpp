// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "dynamics/procedure/coordinates_along.hpp"
#include "dynamics/symbolic/planar_loop.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

struct SolvedBlock;

/// How a block of coordinates is solved in a program.
enum class BlockSolution : std::uint8_t {
  single,     ///< one coordinate by one row: by a square root at most
  dyad,       ///< two links between known points or lines: by a square root
  distances,  ///< a point at three distances: by a square root
  torn,       ///< corrections of what is cut from a start, the rest in closed form
  newton,     ///< corrections from a start
};
constexpr std::string_view name_of(BlockSolution how) {
  constexpr std::string_view kNames[] = {"closed form", "dyad", "three distances", "torn", "Newton"};
  return kNames[static_cast<std::size_t>(how)];
}

/// Solves a scene's closures on the graph, for a tracer's workspace. What is solved are nodes that nothing is
/// differentiated or simplified through (Graph::held), angles with their cosines and sines; no sine of a
/// solved angle is taken.
class ClosedChains {
 public:
  static constexpr int kCorrections = 2;       ///< by Newton's method, in one evaluation
  static constexpr int kCorrectionsOfCut = 3;  ///< the same where a block is torn

  explicit ClosedChains(TracedInputs in) : in_(std::move(in)) {}

  /// As Workspace::solve, where the inputs are.
  void solve(const Model<Expression>& model, Workspace<Expression>& ws);

  /// As Tracer::cuts, from the coordinates' C.
  std::vector<Cut> cuts(const Workspace<Expression>& ws) const;
  /// As Tracer::solved_from_start; nothing where no block is solved so.
  std::vector<Expression> solved_from_start(const Model<Expression>& model, Workspace<Expression> ws) const;
  /// The solution as start_size() numbers: a start for what comes next.
  std::vector<Expression> solution(const Scene& scene, const Workspace<Expression>& ws) const;
  const std::vector<Expression>& corrections() const { return corrections_; }
  std::vector<Expression> stretches() const;
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
  SolvedBlock solve_block(const Model<Expression>& model, int block,
                          detail::CoordinatesAlong<Expression>& along);

  const TracedInputs in_;
  std::vector<BlockSolution> how_;
  std::vector<Expression> corrections_;
  std::vector<Angle> angles_;
  std::vector<Length> lengths_;
};

/// A scene's coordinates on the graph, its closures solved: what is asked of them beside their dynamics.
class ClosedCoordinates {
 public:
  explicit ClosedCoordinates(const std::shared_ptr<const Scene>& scene);

  const TracedInputs& inputs() const { return in_; }
  const ExpressionMatrix& C() const { return ws_.C; }
  const Expression& q(int coordinate) const { return ws_.q[coordinate]; }
  const Expression& x(int coordinate) const { return ws_.x[coordinate]; }  ///< of a solved one
  Expression by_time(int coordinate) const { return by_time_[static_cast<std::size_t>(coordinate)]; }
  /// All rows of all closures.
  std::vector<Expression> rows();
  /// By how much each solved angle's cosine and sine are off the unit circle.
  std::vector<Expression> stretches() const { return chains_.stretches(); }
  /// Of a block's rows by its unknowns.
  ExpressionMatrix slopes(const Scene::Block& block);
  /// What a block is solved with there.
  const SmallSystem<Expression>& system(std::size_t block) const { return ws_.systems[block]; }
  std::vector<Expression> solution() const { return chains_.solution(*model_.scene, ws_); }
  const std::vector<Expression>& corrections() const { return chains_.corrections(); }
  const std::vector<BlockSolution>& solutions() const { return chains_.solutions(); }
  /// As cut_of.
  std::vector<int> cut(int block);

 private:
  TracedInputs in_;
  Model<Expression> model_;
  Workspace<Expression> ws_;
  ClosedChains chains_;
  std::vector<Expression> by_time_;
};

}  // namespace mixloop
