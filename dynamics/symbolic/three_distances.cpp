// SPDX-License-Identifier: MIT
// Three distances of what slides along three axes at right angles: a point on three spheres.
#include <array>
#include <cmath>

#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/stand_ins.hpp"

namespace mixloop {
namespace {

using E = Expression;
using Triple = std::array<E, 3>;

E product(const Triple& a, const Triple& b) { return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]); }
Triple crossed(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Triple less(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// |x|^2 / 2 + b . x + c = 0.
struct Sphere {
  Triple b;
  E c;
};

/// A row as a sphere; nothing where it is none.
std::optional<Sphere> sphere_of(const E& row, const std::vector<E>& x) {
  Sphere sphere;
  double unit = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const E first = slope(row, x[k]);
    for (std::size_t l = 0; l < 3; ++l) {
      const E second = slope(first, x[l]);
      if (!second.is_number()) return std::nullopt;
      if (k == 0 && l == 0) unit = second.number();
      if (!(unit > 0) || std::abs(second.number() - (k == l ? unit : 0)) > 1e-14 * unit) return std::nullopt;
    }
    sphere.b[k] = without(first, x) * E(1 / unit);
  }
  sphere.c = without(row, x) * E(1 / unit);
  return sphere;
}

}  // namespace

// The differences of the three are planes u . x = d, v . x = e, which meet in a line along w = u x v:
//   x = x0 + s w,  x0 = (d (v x w) + e (w x u)) / w.w,
//   w.w s = -b.w +- sqrt((b.w)^2 - w.w (|x0|^2 + 2 b.x0 + 2 c)),
// where the root is det(d rows / d x): zero at the singular pose, its sign that of home.
std::optional<SolvedBlock> solve_three_distances(const Model<E>& model, int number, AlongOnGraph& along) {
  const Scene& scene = *model.scene;
  const Scene::Block& block = scene.blocks[static_cast<std::size_t>(number)];
  if (block.unknowns.size() != 3 || !block.within.empty()) return std::nullopt;
  for (int j : block.unknowns)
    if (scene.turns(j)) return std::nullopt;
  StandIns places(number);
  std::vector<E> x;
  for (std::size_t k = 0; k < 3; ++k) along.x(block.unknowns[k]) = x.emplace_back(places.next());
  along.settle(block);
  std::vector<Sphere> spheres;
  for (const auto& row : along.rows_of(block)) {
    auto sphere = sphere_of(row.v, x);
    if (!sphere) return std::nullopt;
    spheres.push_back(std::move(*sphere));
  }
  places.forget();
  const auto& [b, c] = spheres[0];
  const Triple u = less(spheres[1].b, b), v = less(spheres[2].b, b), w = crossed(u, v);
  const E d = c - spheres[1].c, e = c - spheres[2].c;
  const E W = product(w, w), inverse = E(1.0) / W, b_w = product(b, w);
  const Triple by_d = crossed(v, w), by_e = crossed(w, u);
  Triple foot;
  for (std::size_t k = 0; k < 3; ++k) foot[k] = (d * by_d[k] + e * by_e[k]) * inverse;
  const E square = b_w * b_w - W * (product(foot, foot) + E(2.0) * (product(b, foot) + c));
  HomeValues home(scene);
  double at_home = home.of(b_w);
  for (std::size_t k = 0; k < 3; ++k)
    at_home += home.of(w[k]) * scene.coordinates[static_cast<std::size_t>(block.unknowns[k])].home;
  const E s = ((at_home < 0 ? -sqrt(square) : sqrt(square)) - b_w) * inverse;
  SolvedBlock solved;
  for (std::size_t k = 0; k < 3; ++k) {
    solved.x.push_back(E::held(foot[k] + s * w[k], 1 + static_cast<unsigned>(8 * number)));
    solved.lengths.push_back({block.unknowns[k], solved.x.back()});
  }
  return solved;
}

}  // namespace mixloop
