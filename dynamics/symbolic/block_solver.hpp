// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "dynamics/procedure/coordinates_along.hpp"
#include "dynamics/symbolic/closed_chains.hpp"

namespace mixloop {

using AlongOnGraph = detail::CoordinatesAlong<Expression>;

/// What a block's solution leaves.
struct SolvedBlock {
  std::vector<Expression> x;  ///< of its unknowns
  std::vector<ClosedChains::Angle> angles;
  std::vector<ClosedChains::Length> lengths;
  std::vector<Expression> corrections;
  std::vector<SmallSystem<Expression>::Alone> links;  ///< of a torn one
};

/// An expression's value at home, at t = 0, with the parameters' defaults.
class HomeValues {
 public:
  explicit HomeValues(const Scene& scene) : scene_(scene) {}
  double of(const Expression& x);

 private:
  double input(Block block, std::size_t index) const;

  const Scene& scene_;
  std::vector<double> known_;
};

/// Where a solved coordinate is searched from: its value, and an angle's cosine and sine. Inputs of the
/// graph.
struct ClosureStart {
  Expression value, cosine = 1.0, sine = 0.0;
};
/// The index of a start that a scene has no room for: no program may need it.
constexpr std::size_t kNoStart = 1 << 20;
ClosureStart start_of(const Scene& scene, int coordinate);

/// Two links in a plane between two points, or a point and a line, that are known: nothing where the block is
/// none.
std::optional<SolvedBlock> solve_dyad(const Model<Expression>& model, int block, AlongOnGraph& along);

/// One coordinate and one row, which is linear in its cosine and sine, or of a length no more than quadratic.
std::optional<SolvedBlock> solve_single(const Model<Expression>& model, int block, AlongOnGraph& along);

/// Three lengths along axes at right angles, by three distances: nothing where the block is none.
std::optional<SolvedBlock> solve_three_distances(const Model<Expression>& model, int block,
                                                 AlongOnGraph& along);

/// Any block, by corrections from its start.
SolvedBlock solve_by_newton(const Model<Expression>& model, int block, AlongOnGraph& along);

/// A block that is torn: corrections of the coordinates that are cut, the others in closed form.
SolvedBlock solve_torn(const Model<Expression>& model, int block, AlongOnGraph& along);

/// Which coordinates of a block are to be cut, so that each other one turns a link alone, with the slopes of
/// its rows by its unknowns; none where no link turns alone.
std::vector<int> cut_of(const Model<Expression>& model, int block, const ExpressionMatrix& slopes,
                        AlongOnGraph& along);

/// An angle as it is known by its cosine and sine, near `about`; held, with its pair.
ClosedChains::Angle held_angle(const WholeSum& of, const Planar& direction, const Expression& about,
                               unsigned tag);

}  // namespace mixloop
