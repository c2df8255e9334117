// SPDX-License-Identifier: MIT
// One unknown and one row: an angle whose cosine and sine stand in it linearly, or a length up to its square.
#include <algorithm>
#include <cmath>

#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/stand_ins.hpp"

namespace mixloop {
namespace {

using E = Expression;

/// Numbers but for their rounding, or one node.
bool are_equal(const E& x, const E& y) {
  if (x.is_number() != y.is_number()) return false;
  if (!x.is_number()) return x.node() == y.node();
  return std::abs(x.number() - y.number()) <= 1e-14 * std::max(std::abs(x.number()), std::abs(y.number()));
}

class Single {
 public:
  Single(const Model<E>& model, int block, AlongOnGraph& along)
      : model_(model),
        scene_(*model.scene),
        block_(scene_.blocks[static_cast<std::size_t>(block)]),
        number_(block),
        unknown_(block_.unknowns[0]),
        along_(along),
        home_(scene_) {}

  std::optional<SolvedBlock> solved() { return scene_.turns(unknown_) ? angle() : length(); }

 private:
  E row_where(const E& x) {
    along_.x(unknown_) = x;
    along_.settle(block_);
    return along_.rows_of(block_)[0].v;
  }

  unsigned tag() const { return 1 + static_cast<unsigned>(8 * number_); }
  double at_home() const { return scene_.coordinates[static_cast<std::size_t>(unknown_)].home; }

  /// What else turns along with the unknown in all of a planar loop: its angle from the ground is solved for.
  WholeSum beside() const {
    const auto loop = planar_loop(model_, block_.rows[0].closure);
    std::optional<WholeSum> all;
    if (loop)
      for (const LoopVector& vector : loop->vectors) {
        const auto mine = vector.turned.find(unknown_);
        if (mine == vector.turned.end()) continue;
        if (std::abs(mine->second) != 1 || (all && *all != vector.turned)) return {{unknown_, 1}};
        // What itself follows from the unknown is not known beside it.
        for (const auto& [j, multiple] : vector.turned)
          if (std::count(block_.within.begin(), block_.within.end(), j) > 0) return {{unknown_, 1}};
        all = vector.turned;
      }
    return all.value_or(WholeSum{{unknown_, 1}});
  }

  // A c + B s + C = 0, beside what is on the unit circle constant.
  std::optional<SolvedBlock> angle() {
    WholeSum of = beside();
    const int sense = of.at(unknown_);
    E known = 0.0;
    double alpha = 0;
    for (const auto& [j, multiple] : of) {
      alpha += multiple * scene_.coordinates[static_cast<std::size_t>(j)].home;
      if (j != unknown_) known += along_.along(j).v * E(multiple);
    }
    StandIns places(number_);
    const E angle = places.next(), c = places.next(), s = places.next();
    recording_graph().set_pair(angle.node(), c.node(), s.node());
    const E row = row_where((angle - known) * E(sense));
    E A = slope(row, c), B = slope(row, s), C = without(row, {c, s});
    // Of a distance's square half of each second derivative stands beside c^2 + s^2 = 1.
    const E square = slope(A, c);
    if (!is_zero(slope(A, s)) || !are_equal(square, slope(B, s))) return std::nullopt;
    A = without(A, {c, s}), B = without(B, {c, s}), C += E(0.5) * square;
    for (const E& part : {square, A, B, C})
      if (depends(part, angle) || depends(part, c) || depends(part, s)) return std::nullopt;
    places.forget();
    Planar direction;
    const double side =
        home_.of(B) * mixloop_functions::cos(alpha) - home_.of(A) * mixloop_functions::sin(alpha);
    if (is_zero(A)) {
      direction.y = -(C / B);
      direction.x =
          sqrt((E(1.0) - direction.y) * (E(1.0) + direction.y)) * sign(mixloop_functions::cos(alpha));
    } else if (is_zero(B)) {
      direction.x = -(C / A);
      direction.y =
          sqrt((E(1.0) - direction.x) * (E(1.0) + direction.x)) * sign(mixloop_functions::sin(alpha));
    } else {
      const E R = A * A + B * B, inverse = E(1.0) / R, root = sqrt(R - C * C) * sign(side);
      direction = {(B * root - A * C) * inverse, -((A * root + B * C) * inverse)};
    }
    E about = known;
    about += start_of(scene_, unknown_).value * E(sense);
    SolvedBlock solved;
    solved.angles = {held_angle(of, direction, about, tag())};
    solved.x = {(solved.angles[0].angle - known) * E(sense)};
    return solved;
  }

  // C + B x + A x^2 = 0.
  std::optional<SolvedBlock> length() {
    StandIns places(number_);
    const E x = places.next();
    const E row = row_where(x);
    const E first = slope(row, x), second = slope(first, x);
    if (depends(second, x)) return std::nullopt;
    const E B = without(first, {x}), C = without(row, {x});
    places.forget();
    E value;
    if (is_zero(second)) {
      value = -(C / B);
    } else {
      const E root = sqrt(B * B - E(2.0) * second * C);
      value = (root * sign(home_.of(B) + home_.of(second) * at_home()) - B) / second;
    }
    SolvedBlock solved;
    solved.lengths = {{unknown_, E::held(value, tag())}};
    solved.x = {solved.lengths[0].length};
    return solved;
  }

  static E sign(double at_home) { return at_home < 0 ? -1.0 : 1.0; }

  const Model<E>& model_;
  const Scene& scene_;
  const Scene::Block& block_;
  int number_, unknown_;
  AlongOnGraph& along_;
  HomeValues home_;
};

}  // namespace

std::optional<SolvedBlock> solve_single(const Model<E>& model, int block, AlongOnGraph& along) {
  if (model.scene->blocks[static_cast<std::size_t>(block)].unknowns.size() != 1) return std::nullopt;
  return Single(model, block, along).solved();
}

}  // namespace mixloop
