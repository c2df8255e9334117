// SPDX-License-Identifier: MIT
// Two links in a plane between what is known: sines and cosines by a square root, whose sign is that of home.
#include <algorithm>
#include <cmath>
#include <complex>

#include "dynamics/symbolic/block_solver.hpp"

namespace mixloop {
namespace {

using E = Expression;

Planar direction_of(const E& angle) { return {cos(angle), sin(angle)}; }

/// w / u for a vector u of given squared length: of one along x a quotient of numbers.
Planar over(const Planar& w, const Planar& u, const E& squared) {
  if (is_zero(u.y)) return w * (E(1.0) / u.x);
  return w * u.conjugate() * (E(1.0) / squared);
}

/// What turns alike by unknown angles: vectors u, and along k what slides.
struct Group {
  WholeSum unknown;  ///< which angles, as whole multiples
  WholeSum known;    ///< what else all of it turns by
  Planar u, k;
  bool slides = false;
};

class Dyad {
 public:
  Dyad(const Model<E>& model, int block, AlongOnGraph& along)
      : scene_(*model.scene),
        block_(scene_.blocks[static_cast<std::size_t>(block)]),
        number_(block),
        along_(along),
        home_(scene_) {}

  std::optional<SolvedBlock> solved(const PlanarLoop& loop) {
    if (!take_apart(loop)) return std::nullopt;
    if (angles_.size() == 2) return two_angles();
    if (angles_.size() == 1 && lengths_.size() == 1) return angle_and_length();
    return std::nullopt;
  }

 private:
  bool is_unknown(int j) const {
    return std::find(block_.unknowns.begin(), block_.unknowns.end(), j) != block_.unknowns.end();
  }

  E angle_of(const WholeSum& sum) {
    E angle = 0.0;
    for (const auto& [j, multiple] : sum) angle += along_.along(j).v * E(multiple);
    return angle;
  }
  double home_of(const WholeSum& sum) const {
    double angle = 0;
    for (const auto& [j, multiple] : sum) angle += multiple * home_of(j);
    return angle;
  }
  double home_of(int j) const { return scene_.coordinates[static_cast<std::size_t>(j)].home; }

  /// Sorts the loop's vectors by the unknown angles that they turn by.
  bool take_apart(const PlanarLoop& loop) {
    for (int j : block_.unknowns) (scene_.turns(j) ? angles_ : lengths_).push_back(j);
    struct Sorted {
      WholeSum unknown, known;
      Planar is;
      bool slides;
    };
    std::vector<Sorted> sorted;
    for (const LoopVector& vector : loop.vectors) {
      Sorted part{{}, {}, vector.is, false};
      for (const auto& [j, multiple] : vector.turned)
        (is_unknown(j) ? part.unknown : part.known)[j] = multiple;
      if (vector.length >= 0) {
        part.slides = is_unknown(vector.length);
        if (!part.slides) part.is = part.is * along_.along(vector.length).v;
      }
      if (!is_zero(part.is.x) || !is_zero(part.is.y)) sorted.push_back(std::move(part));
    }
    for (const Sorted& part : sorted) {
      auto group = std::find_if(groups_.begin(), groups_.end(),
                                [&](const Group& g) { return g.unknown == part.unknown; });
      if (group == groups_.end()) {
        groups_.push_back({part.unknown, {}, {}, {}});
        group = groups_.end() - 1;
        // The angle from the ground, where all of the group has one.
        const bool alike = std::all_of(sorted.begin(), sorted.end(), [&](const Sorted& other) {
          return other.unknown != part.unknown || other.known == part.known;
        });
        if (alike && !part.unknown.empty()) group->known = part.known;
      }
      WholeSum turned = part.known;
      if (turned == group->known) turned.clear();
      const Planar is = turned.empty() ? part.is : part.is * direction_of(angle_of(turned));
      Planar& sum = part.slides ? group->k : group->u;
      sum = sum + is;
      group->slides = group->slides || part.slides;
    }
    return true;
  }

  /// The part that no unknown angle turns.
  Group still() const {
    for (const Group& group : groups_)
      if (group.unknown.empty()) return group;
    return {};
  }

  E sign(double at_home) const { return at_home < 0 ? -1.0 : 1.0; }
  std::complex<double> at_home(const Planar& p) { return {home_.of(p.x), home_.of(p.y)}; }

  /// The whole angle of a group, held.
  ClosedChains::Angle held(const Group& group, const Planar& direction, unsigned role) {
    E about = angle_of(group.known);
    for (const auto& [j, multiple] : group.unknown) about += start_of(scene_, j).value * E(multiple);
    WholeSum of = group.known;
    of.insert(group.unknown.begin(), group.unknown.end());
    return held_angle(of, direction, about, 1 + static_cast<unsigned>(8 * number_) + role);
  }

  // P + u e^ia + v e^ib = 0.
  std::optional<SolvedBlock> two_angles() {
    std::vector<const Group*> turning;
    for (const Group& group : groups_)
      if (!group.unknown.empty()) turning.push_back(&group);
    if (turning.size() != 2) return std::nullopt;
    const auto multiple = [&](const Group* group, int j) {
      const auto found = group->unknown.find(j);
      return found == group->unknown.end() ? 0 : found->second;
    };
    const int a0 = multiple(turning[0], angles_[0]), a1 = multiple(turning[0], angles_[1]),
              b0 = multiple(turning[1], angles_[0]), b1 = multiple(turning[1], angles_[1]);
    const int determinant = a0 * b1 - a1 * b0;
    if (std::abs(determinant) != 1) return std::nullopt;
    const Planar d = -still().u, u = turning[0]->u, v = turning[1]->u;
    const E U = dot(u, u), V = dot(v, v), D = dot(d, d);
    // With p = conj(d) u e^ia: 2 Re p = D + U - V, and (2 Im p)^2 = ((|u|+|v|)^2 - D) (D - (|u|-|v|)^2).
    const E of_u = is_zero(u.y) ? u.x : sqrt(U), of_v = is_zero(v.y) ? v.x : sqrt(V);
    const E both = of_u + of_v, less = of_u - of_v;
    const E height = sqrt((both * both - D) * (D - less * less));
    const double angle = home_of(turning[0]->unknown) + home_of(turning[0]->known);
    const std::complex<double> turned = at_home(u) * std::polar(1.0, angle), to = at_home(d);
    const Planar p{D + (U - V), height * sign((std::conj(to) * turned).imag())};
    const Planar first =
        is_zero(u.y) ? p * d * (E(0.5) / (D * u.x)) : p * d * (u.conjugate() * (E(0.5) / (D * U)));
    const Planar second = over(d - u * first, v, V);
    SolvedBlock solved;
    solved.angles = {held(*turning[0], first, 0), held(*turning[1], second, 1)};
    const E alpha = solved.angles[0].angle - angle_of(turning[0]->known),
            beta = solved.angles[1].angle - angle_of(turning[1]->known);
    const E x0 = E(determinant * b1) * alpha - E(determinant * a1) * beta,
            x1 = E(determinant * a0) * beta - E(determinant * b0) * alpha;
    solved.x = block_.unknowns[0] == angles_[0] ? std::vector{x0, x1} : std::vector{x1, x0};
    return solved;
  }

  // P + s k + u e^ia = 0, or P + (u + s k) e^ia = 0.
  std::optional<SolvedBlock> angle_and_length() {
    const Group* turning = nullptr;
    for (const Group& group : groups_) {
      if (group.unknown.empty()) continue;
      if (turning != nullptr) return std::nullopt;
      turning = &group;
    }
    if (turning == nullptr || std::abs(turning->unknown.begin()->second) != 1) return std::nullopt;
    const Group still = this->still();
    if (still.slides == turning->slides) return std::nullopt;
    const double s_home = home_of(lengths_[0]);
    const E U = dot(turning->u, turning->u);
    E s;
    Planar direction;
    const auto root = [&](const Planar& k, const Planar& from, const E& squared_reach) {
      const E K = dot(k, k), b = dot(k, from), across = cross(k, from);
      const double at_home = s_home * home_.of(K) + home_.of(b);
      return (sign(at_home) * sqrt(K * squared_reach - across * across) - b) * (E(1.0) / K);
    };
    if (still.slides) {
      s = root(still.k, still.u, U);
      direction = over(-(still.u + still.k * s), turning->u, U);
    } else {
      const E D = dot(still.u, still.u);
      s = root(turning->k, turning->u, D);
      const Planar arm = turning->u + turning->k * s;
      direction = -still.u * arm.conjugate() * (E(1.0) / D);
    }
    SolvedBlock solved;
    solved.angles = {held(*turning, direction, 0)};
    solved.lengths = {{lengths_[0], E::held(s, 1 + static_cast<unsigned>(8 * number_))}};
    const E alpha = (solved.angles[0].angle - angle_of(turning->known)) * E(turning->unknown.begin()->second);
    const E& length = solved.lengths[0].length;
    solved.x = block_.unknowns[0] == angles_[0] ? std::vector{alpha, length} : std::vector{length, alpha};
    return solved;
  }

  const Scene& scene_;
  const Scene::Block& block_;
  int number_;
  AlongOnGraph& along_;
  HomeValues home_;
  std::vector<int> angles_, lengths_;
  std::vector<Group> groups_;
};

}  // namespace

std::optional<SolvedBlock> solve_dyad(const Model<E>& model, int block, AlongOnGraph& along) {
  const Scene::Block& said = model.scene->blocks[static_cast<std::size_t>(block)];
  if (said.unknowns.size() != 2 || !said.within.empty() || said.rows[0].closure != said.rows[1].closure)
    return std::nullopt;
  const auto loop = planar_loop(model, said.rows[0].closure);
  if (!loop) return std::nullopt;
  return Dyad(model, block, along).solved(*loop);
}

}  // namespace mixloop
