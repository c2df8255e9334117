// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/planar_loop.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {
namespace {

using E = Expression;
using V3 = Vec3<E>;
using M3 = Mat3<E>;

/// +1 along the direction, -1 against it, 0 across; nothing where it is neither, or not known.
std::optional<int> along(const V3& direction, const V3& v) {
  const E dot = direction.dot(v);
  const auto near = [&](double value) { return dot.is_number() && std::abs(dot.number() - value) < 1e-14; };
  if (near(1)) return 1;
  if (near(-1)) return -1;
  if (near(0)) return 0;
  return std::nullopt;
}

M3 turned_about_z(const M3& R, const E& c, const E& s) {
  M3 turned = R;
  for (Eigen::Index i = 0; i < 3; ++i) {
    turned(i, 0) = R(i, 0) * c + R(i, 1) * s;
    turned(i, 1) = R(i, 1) * c - R(i, 0) * s;
  }
  return turned;
}

M3 turned_about_x(const M3& R, const E& c, const E& s) {
  M3 turned = R;
  for (Eigen::Index i = 0; i < 3; ++i) {
    turned(i, 1) = R(i, 1) * c + R(i, 2) * s;
    turned(i, 2) = R(i, 2) * c - R(i, 1) * s;
  }
  return turned;
}

M3 unit() {
  M3 R = M3::Constant(E(0.0));
  for (Eigen::Index i = 0; i < 3; ++i) R(i, i) = E(1.0);
  return R;
}

/// Walks along both chains, in the axes of the frame where they part; what the frame is turned by beside the
/// sum of coordinates is constant.
class Walk {
 public:
  Walk(const Model<E>& model, int closure)
      : model_(model),
        said_(model.scene->closures[static_cast<std::size_t>(closure)]),
        made_(model.closures[static_cast<std::size_t>(closure)]) {}

  std::optional<PlanarLoop> loop() {
    for (std::size_t end : {0u, 1u}) {
      sign_ = end == 1 ? 1.0 : -1.0;
      R_ = unit();
      turned_.clear();
      for (int link : chain(said_.frames[end]))
        if (!go_on(model_.links[static_cast<std::size_t>(link)])) return std::nullopt;
      add(R_.lazyProduct(made_.vectors[end]), -1);
    }
    if (!normal_) return std::nullopt;
    PlanarLoop loop;
    const auto [one, other] = plane();
    loop.has_axes = has_axes();
    for (const Part& part : parts_) {
      const V3 is = part.is;
      loop.vectors.push_back({{is.dot(one), is.dot(other)}, part.turned, part.length});
    }
    return loop;
  }

 private:
  struct Part {
    V3 is;
    WholeSum turned;
    int length;
  };

  std::vector<int> chain(int frame) const {
    int a = said_.frames[0], b = said_.frames[1];
    while (a != b) (a > b ? a : b) = model_.links[static_cast<std::size_t>(std::max(a, b) - 1)].parent;
    std::vector<int> links;
    for (; frame != a; frame = model_.links[static_cast<std::size_t>(frame - 1)].parent)
      links.insert(links.begin(), frame - 1);
    return links;
  }

  void add(const V3& v, int length) {
    const V3 is = v * E(sign_);
    for (Part& part : parts_)
      if (part.turned == turned_ && part.length == length) {
        part.is += is;
        return;
      }
    parts_.push_back({is, turned_, length});
  }

  bool go_on(const Model<E>::Link& link) {
    const V3 z = R_.col(2);
    if (link.coordinate >= 0 && !link.prismatic) {
      if (!link.scale.is_number() || link.scale.number() != std::round(link.scale.number())) return false;
      if (!std::all_of(z.begin(), z.end(), [](const E& part) { return part.is_number(); })) return false;
      if (!normal_) normal_ = z;
      const auto sense = along(*normal_, z);
      if (!sense || *sense == 0 || !all_across()) return false;
      int& multiple = turned_[link.coordinate];
      multiple += *sense * static_cast<int>(link.scale.number());
      if (multiple == 0) turned_.erase(link.coordinate);
      E c = cos(link.theta), s = sin(link.theta);
      if (link.theta.is_number()) detail::constant_cos_sin(link.theta.number(), c, s);
      R_ = turned_about_z(R_, c, s);
    } else {
      R_ = turned_about_z(R_, link.cos_theta, link.sin_theta);
    }
    if (link.coordinate >= 0 && link.prismatic) {
      slides_.push_back(z);
      if (!all_across()) return false;
      add(z * link.scale, link.coordinate);
    }
    add(V3(R_.col(0) * link.a + z * link.s), -1);
    R_ = turned_about_x(R_, link.cos_alpha, link.sin_alpha);
    return true;
  }

  /// Whether what slides does so in the plane, as far as the plane is known.
  bool all_across() const {
    return !normal_ || std::all_of(slides_.begin(), slides_.end(),
                                   [&](const V3& slide) { return along(*normal_, slide) == 0; });
  }

  bool has_axes() const {
    return std::any_of(normal_->begin(), normal_->end(),
                       [](const E& part) { return std::abs(part.number()) == 1; });
  }

  /// Two directions across the normal: the axes' own where it is one of them.
  std::pair<V3, V3> plane() const {
    const V3& n = *normal_;
    Eigen::Index most = 0, least = 0;
    for (Eigen::Index i = 1; i < 3; ++i) {
      if (std::abs(n[i].number()) > std::abs(n[most].number())) most = i;
      if (std::abs(n[i].number()) < std::abs(n[least].number())) least = i;
    }
    V3 one;
    if (std::abs(n[most].number()) == 1) {
      one = V3(E(0.0), E(0.0), E(0.0));
      one[(most + 1) % 3] = E(1.0);
    } else {
      const auto both = detail::across<E>(n, static_cast<int>(least));
      one = both[0];
    }
    return {one,
            V3(n[1] * one[2] - n[2] * one[1], n[2] * one[0] - n[0] * one[2], n[0] * one[1] - n[1] * one[0])};
  }

  const Model<E>& model_;
  const Scene::Closure& said_;
  const Model<E>::Closure& made_;
  double sign_ = 1;
  M3 R_;
  WholeSum turned_;
  std::vector<Part> parts_;
  std::vector<V3> slides_;
  std::optional<V3> normal_;
};

}  // namespace

std::optional<PlanarLoop> planar_loop(const Model<Expression>& model, int closure) {
  const auto& said = model.scene->closures[static_cast<std::size_t>(closure)];
  if (!said.has_points() || said.in >= 0) return std::nullopt;
  return Walk(model, closure).loop();
}

}  // namespace mixloop
