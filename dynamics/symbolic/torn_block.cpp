// SPDX-License-Identifier: MIT
// A torn block: what turns alone in a planar loop of the block follows from the others, which are cut out and
// corrected.
//
// Of a loop P + u e^ia = 0, where nothing else in the block depends on the angle a, whatever the others are:
//   |P|^2 = |u|^2,  e^ia = -P / u.
// The first is a row without a; the second is regular wherever the loop closes, so that the rows that are
// left are singular where the block is, and nowhere else.
#include <algorithm>
#include <cmath>

#include "dynamics/symbolic/iterate.hpp"
#include "dynamics/symbolic/stand_ins.hpp"

namespace mixloop {
namespace {

using E = Expression;

/// A link that turns alone: unknown `j`, its vector u, all that it turns by, and the loop's other vectors.
struct Link {
  int unknown = -1;
  std::array<std::size_t, 2> rows{};  ///< in the block's
  WholeSum turned;
  Planar u;
  std::vector<LoopVector> others;
};

bool has(const std::vector<int>& all, int j) { return std::find(all.begin(), all.end(), j) != all.end(); }

class Links {
 public:
  Links(const Model<E>& model, int block, AlongOnGraph& along)
      : model_(model), block_(model.scene->blocks[static_cast<std::size_t>(block)]), along_(along) {}

  /// Of those that a loop has the longest; slopes of the block's rows by its unknowns say what is alone.
  std::vector<Link> found(const ExpressionMatrix& slopes) {
    std::vector<Link> links;
    for (const auto& rows : loops()) {
      const auto loop = planar_loop(model_, block_.rows[rows[0]].closure);
      if (!loop || !loop->has_axes) continue;
      std::optional<Link> longest;
      double most = 0;
      for (std::size_t i = 0; i < block_.unknowns.size(); ++i) {
        if (!is_alone(slopes, static_cast<Eigen::Index>(i), rows)) continue;
        auto link = link_of(*loop, block_.unknowns[i]);
        if (!link) continue;
        link->rows = rows;
        HomeValues home(*model_.scene);
        const double length = home.of(dot(link->u, link->u));
        if (!(length > most)) continue;
        most = length;
        longest = std::move(link);
      }
      if (longest) links.push_back(std::move(*longest));
    }
    return links;
  }

  /// The same, where it is known which unknowns are cut.
  std::vector<Link> beside_cut() {
    std::vector<Link> links;
    for (const auto& rows : loops()) {
      const auto loop = planar_loop(model_, block_.rows[rows[0]].closure);
      if (!loop || !loop->has_axes) continue;
      for (int j : block_.unknowns) {
        if (has(block_.cut, j)) continue;
        auto link = link_of(*loop, j);
        if (!link) continue;
        link->rows = rows;
        links.push_back(std::move(*link));
      }
    }
    return links;
  }

 private:
  /// The pairs of the block's rows that are of one closure of points.
  std::vector<std::array<std::size_t, 2>> loops() const {
    std::vector<std::array<std::size_t, 2>> pairs;
    for (std::size_t i = 0; i < block_.rows.size();) {
      std::size_t end = i;
      while (end < block_.rows.size() && block_.rows[end].closure == block_.rows[i].closure) ++end;
      const auto kind = model_.scene->closures[static_cast<std::size_t>(block_.rows[i].closure)].kind;
      if (end == i + 2 && kind == Scene::Closure::Kind::coincide) pairs.push_back({i, i + 1});
      i = end;
    }
    return pairs;
  }

  /// No other row depends on the unknown, and nothing that has a formula.
  bool is_alone(const ExpressionMatrix& slopes, Eigen::Index unknown,
                const std::array<std::size_t, 2>& rows) {
    for (Eigen::Index i = 0; i < slopes.rows(); ++i)
      if (static_cast<std::size_t>(i) != rows[0] && static_cast<std::size_t>(i) != rows[1] &&
          !is_zero(slopes(i, unknown)))
        return false;
    const int j = block_.unknowns[static_cast<std::size_t>(unknown)];
    along_.settle(block_);
    along_.along(j).d = E(1.0);
    for (int w : block_.within) along_.by_formula(w);
    const bool alone = std::all_of(block_.within.begin(), block_.within.end(),
                                   [&](int w) { return is_zero(along_.along(w).d); });
    along_.settle(block_);
    return alone;
  }

  std::optional<Link> link_of(const PlanarLoop& loop, int j) const {
    if (!model_.scene->turns(j)) return std::nullopt;
    Link link{.unknown = j};
    for (const LoopVector& vector : loop.vectors) {
      if (vector.length == j) return std::nullopt;
      const auto mine = vector.turned.find(j);
      if (mine == vector.turned.end()) {
        link.others.push_back(vector);
        continue;
      }
      // One vector, as long as it is; where two turn by other sums beside, or one slides, it is no link.
      if (!link.turned.empty() || vector.length >= 0 || std::abs(mine->second) != 1) return std::nullopt;
      link.turned = vector.turned;
      link.u = vector.is;
    }
    if (link.turned.empty()) return std::nullopt;
    return link;
  }

  const Model<E>& model_;
  const Scene::Block& block_;
  AlongOnGraph& along_;
};

/// A vector in the loop's plane, with how it goes along what the coordinates go along.
struct Going {
  Planar is, rate;
};

class Torn {
 public:
  Torn(const Model<E>& model, int block, AlongOnGraph& along)
      : scene_(*model.scene),
        block_(scene_.blocks[static_cast<std::size_t>(block)]),
        number_(block),
        along_(along),
        links_(Links(model, block, along).beside_cut()) {
    for (std::size_t i = 0; i < block_.rows.size(); ++i)
      if (std::none_of(links_.begin(), links_.end(),
                       [&](const Link& link) { return link.rows[0] == i || link.rows[1] == i; }))
        rows_.push_back(block_.rows[i]);
  }

  SolvedBlock solved() {
    std::vector<Iterate> at;
    for (int j : block_.cut) at.push_back(iterate_on_the_circle(scene_, j, tag(0)));
    SolvedBlock solved;
    constexpr Turning kTurning[] = {Turning::exact, Turning::small, Turning::least};
    static_assert(std::size(kTurning) == ClosedChains::kCorrectionsOfCut);
    for (int k = 0; k < ClosedChains::kCorrectionsOfCut; ++k) {
      const ExpressionVector by = correction(at);
      solved.corrections.assign(by.begin(), by.end());
      for (std::size_t i = 0; i < at.size(); ++i)
        at[i] = corrected(at[i], by[static_cast<Eigen::Index>(i)], scene_.turns(block_.cut[i]), tag(1 + k),
                          kTurning[k]);
    }
    put(at, -1);
    for (std::size_t i = 0; i < at.size(); ++i) add_to(solved, scene_, block_.cut[i], at[i]);
    std::vector<E> x(scene_.coordinates.size());
    for (std::size_t i = 0; i < at.size(); ++i) x[static_cast<std::size_t>(block_.cut[i])] = at[i].value;
    for (const Link& link : links_) {
      x[static_cast<std::size_t>(link.unknown)] = turn(link, solved);
      solved.links.push_back({static_cast<Eigen::Index>(link.rows[0]),
                              static_cast<Eigen::Index>(link.rows[1]), place_of(link.unknown),
                              dot(link.u, link.u)});
    }
    for (int j : block_.unknowns) solved.x.push_back(x[static_cast<std::size_t>(j)]);
    return solved;
  }

 private:
  unsigned tag(int role) const { return 1 + static_cast<unsigned>(8 * number_ + role); }
  Eigen::Index place_of(int unknown) const {
    return std::find(block_.unknowns.begin(), block_.unknowns.end(), unknown) - block_.unknowns.begin();
  }

  /// The cut coordinates are there; one of them moves, or none.
  void put(const std::vector<Iterate>& at, int moving) {
    for (std::size_t i = 0; i < at.size(); ++i)
      along_.along(block_.cut[i]) = Taylor<E>(at[i].value, E(static_cast<int>(i) == moving ? 1 : 0), E(0));
    for (int w : block_.within) along_.by_formula(w);
  }

  Taylor<E> angle_of(const WholeSum& sum, int without = -1) {
    Taylor<E> angle;
    for (const auto& [j, multiple] : sum)
      if (j != without) angle = angle + Taylor<E>(E(multiple)) * along_.along(j);
    return angle;
  }

  /// The loop without its link, P.
  Going rest_of(const Link& link) {
    Going P;
    for (const LoopVector& vector : link.others) {
      const Taylor<E> angle = angle_of(vector.turned);
      Planar is = vector.turned.empty() ? vector.is : vector.is * Planar{cos(angle.v), sin(angle.v)};
      if (vector.length >= 0) {
        const Taylor<E>& length = along_.along(vector.length);
        P.rate = P.rate + is * length.d;
        is = is * length.v;
      }
      P.is = P.is + is;
      P.rate = P.rate + Planar{-is.y, is.x} * angle.d;
    }
    return P;
  }

  // |P|^2 / 2 - |u|^2 / 2 of each link, then the rows that are of none.
  ExpressionVector correction(const std::vector<Iterate>& at) {
    const auto k = static_cast<Eigen::Index>(at.size());
    ExpressionMatrix slopes(k, k);
    ExpressionVector right(k);
    for (Eigen::Index c = 0; c < k; ++c) {
      put(at, static_cast<int>(c));
      Eigen::Index i = 0;
      for (const Link& link : links_) {
        const Going P = rest_of(link);
        slopes(i, c) = dot(P.is, P.rate);
        right[i++] = E(0.5) * (dot(link.u, link.u) - dot(P.is, P.is));
      }
      for (const auto& row : along_.rows_of(rows_)) {
        slopes(i, c) = row.d;
        right[i++] = -row.v;
      }
    }
    return SmallSystem<E>(slopes).solve(right);
  }

  // e^ia = -P / u, held: the unknown's value.
  E turn(const Link& link, SolvedBlock& solved) {
    const Planar P = rest_of(link).is;
    const Planar direction = is_zero(link.u.y) ? P * (E(-1.0) / link.u.x)
                                               : -P * link.u.conjugate() * (E(1.0) / dot(link.u, link.u));
    const E known = angle_of(link.turned, link.unknown).v;
    const E sense(link.turned.at(link.unknown));
    solved.angles.push_back(held_angle(link.turned, direction,
                                       known + start_of(scene_, link.unknown).value * sense,
                                       tag(1 + ClosedChains::kCorrectionsOfCut)));
    return (solved.angles.back().angle - known) * sense;
  }

  const Scene& scene_;
  const Scene::Block& block_;
  int number_;
  AlongOnGraph& along_;
  std::vector<Link> links_;
  std::vector<Scene::ClosureRow> rows_;  ///< of no link
};

}  // namespace

std::vector<int> cut_of(const Model<E>& model, int block, const ExpressionMatrix& slopes,
                        AlongOnGraph& along) {
  const auto& unknowns = model.scene->blocks[static_cast<std::size_t>(block)].unknowns;
  const auto links = Links(model, block, along).found(slopes);
  std::vector<int> cut;
  const auto left = static_cast<Eigen::Index>(unknowns.size() - links.size());
  if (links.empty() || left == 0 || left > SmallSystem<E>::kMostByCofactors) return cut;
  for (int j : unknowns)
    if (std::none_of(links.begin(), links.end(), [&](const Link& link) { return link.unknown == j; }))
      cut.push_back(j);
  return cut;
}

SolvedBlock solve_torn(const Model<E>& model, int block, AlongOnGraph& along) {
  return Torn(model, block, along).solved();
}

}  // namespace mixloop
