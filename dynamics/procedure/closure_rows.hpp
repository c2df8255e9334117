// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "dynamics/procedure/model.hpp"

namespace mixloop {

/// A frame's pose in the axes of one that it hangs on, on a scalar X. Turns about one axis are added up
/// before their sine is taken: of links that turn in one plane the angles from the ground count, not those
/// from link to link.
template <class X>
struct PoseAlong {
  using Column = std::array<X, 3>;
  std::array<Column, 3> axes;  ///< the frame's x, y and z
  Column origin;

  PoseAlong() : turn_(0.0) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) axes[i][j] = X(i == j ? 1.0 : 0.0);
    base_ = {axes[0], axes[1]};
    origin.fill(X(0.0));
  }

  /// To the frame that a transform makes of this one: about z by an angle, or by a constant one's
  /// cosine and sine; then along z and x, and about x.
  void turn(const X& angle) {
    turn_ = turns_ ? X(turn_ + angle) : angle;
    turns_ = true;
    using mixloop_functions::cos, mixloop_functions::sin;
    turn(base_[0], base_[1], cos(turn_), sin(turn_));
  }
  void turn(const X& cosine, const X& sine) {
    turn(Column(axes[0]), Column(axes[1]), cosine, sine);
    turn(base_, cosine, sine);
  }
  void shift(const X& s, const X& a) {
    for (std::size_t i = 0; i < 3; ++i) origin[i] = origin[i] + (axes[0][i] * a + axes[2][i] * s);
  }
  void twist(const X& cosine, const X& sine, Twist by) {
    auto& [x, y, z] = axes;
    if (by == Twist::none) return;
    if (by == Twist::half) {
      for (std::size_t i = 0; i < 3; ++i) {
        y[i] = -y[i], z[i] = -z[i];
        base_[1][i] = -base_[1][i];
      }
      turn_ = -turn_;
      return;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const X across = y[i], up = z[i];
      y[i] = across * cosine + up * sine;
      z[i] = up * cosine - across * sine;
    }
    base_ = {x, y};
    turn_ = X(0.0);
    turns_ = false;
  }

  /// A vector of the frame's axes in the other's.
  template <class V>
  Column turned(const V& v) const {
    Column result;
    for (std::size_t i = 0; i < 3; ++i)
      result[i] = axes[0][i] * v[0] + (axes[1][i] * v[1] + axes[2][i] * v[2]);
    return result;
  }

 private:
  void turn(const Column& from_x, const Column& from_y, const X& c, const X& s) {
    for (std::size_t i = 0; i < 3; ++i) {
      axes[0][i] = from_x[i] * c + from_y[i] * s;
      axes[1][i] = from_y[i] * c - from_x[i] * s;
    }
  }
  void turn(std::array<Column, 2>& base, const X& c, const X& s) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const X x = base[0][i] * c + base[1][i] * s;
      base[1][i] = base[1][i] * c - base[0][i] * s;
      base[0][i] = x;
    }
  }

  std::array<Column, 2> base_;  ///< x and y before they turned by turn_
  X turn_;
  bool turns_ = false;
};

/// Evaluates the rows of a scene's closures where coordinates q, motors and time go along a line.
/// `along(j)` gives coordinate j and `symbol(number)` a formula's symbol, both as Taylor<T>.
template <class T, class Along, class Lookup>
class ClosureRows {
 public:
  using X = Taylor<T>;
  using Column = typename PoseAlong<X>::Column;

  ClosureRows(const Model<T>& model, const Along& along, const Lookup& symbol)
      : model_(model), along_(along), symbol_(symbol) {}

  /// All rows of one closure, in m or rad.
  std::vector<X> of(int index) const {
    using Kind = Scene::Closure::Kind;
    const auto& said = model_.scene->closures[static_cast<std::size_t>(index)];
    switch (said.kind) {
      case Kind::coincide:
        return coincide(said, index);
      case Kind::distance:
        return {distance(said, index)};
      case Kind::parallel:
        return parallel(said, index);
      case Kind::align:
        return align(said);
      case Kind::zero:
        return {evaluate<X>(said.value, symbol_)};
    }
    return {};
  }

 private:
  using Pose = PoseAlong<X>;
  static X number(const T& value) { return X(value); }

  /// The frame where the chains to both part.
  int parting(int a, int b) const {
    while (a != b) (a > b ? a : b) = model_.links[static_cast<std::size_t>(std::max(a, b) - 1)].parent;
    return a;
  }

  Pose pose(int from, int to) const {
    std::vector<int> chain;
    for (; to != from; to = model_.links[static_cast<std::size_t>(to - 1)].parent) chain.push_back(to);
    Pose pose;
    for (; !chain.empty(); chain.pop_back()) {
      const auto& link = model_.links[static_cast<std::size_t>(chain.back() - 1)];
      X s = number(link.s);
      if (link.coordinate >= 0 && link.prismatic) s = X(link.scale) * along_(link.coordinate) + s;
      if (link.coordinate >= 0 && !link.prismatic)
        pose.turn(X(link.scale) * along_(link.coordinate) + number(link.theta));
      else
        pose.turn(number(link.cos_theta), number(link.sin_theta));
      pose.shift(s, number(link.a));
      pose.twist(number(link.cos_alpha), number(link.sin_alpha), link.twist);
    }
    return pose;
  }

  Column place(const Pose& pose, const Vec3<T>& point) const {
    Column place = pose.turned(std::array<X, 3>{number(point[0]), number(point[1]), number(point[2])});
    for (std::size_t i = 0; i < 3; ++i) place[i] = pose.origin[i] + place[i];
    return place;
  }

  static X dot(const Column& a, const Column& b) { return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]); }

  /// p2 - p1, in the axes of `in`.
  Column apart(const Scene::Closure& said, int index, int in) const {
    const auto& made = model_.closures[static_cast<std::size_t>(index)];
    int root = parting(said.frames[0], said.frames[1]);
    if (in >= 0) root = parting(root, in);
    const Column one = place(pose(root, said.frames[0]), made.vectors[0]),
                 two = place(pose(root, said.frames[1]), made.vectors[1]);
    Column apart;
    for (std::size_t i = 0; i < 3; ++i) apart[i] = two[i] - one[i];
    if (in < 0 || in == root) return apart;
    const Pose axes = pose(root, in);
    return {dot(axes.axes[0], apart), dot(axes.axes[1], apart), dot(axes.axes[2], apart)};
  }

  std::vector<X> coincide(const Scene::Closure& said, int index) const {
    const Column all = apart(said, index, said.in);
    std::vector<X> rows;
    for (int axis : said.axes) rows.push_back(all[static_cast<std::size_t>(axis)]);
    return rows;
  }

  X distance(const Scene::Closure& said, int index) const {
    const Column r = apart(said, index, -1);
    const X length = evaluate<X>(said.value, symbol_);
    return (dot(r, r) - length * length) * number(T(0.5 / said.home_length));
  }

  std::vector<X> parallel(const Scene::Closure& said, int index) const {
    const auto& made = model_.closures[static_cast<std::size_t>(index)];
    const int root = parting(said.frames[0], said.frames[1]);
    const Pose one = pose(root, said.frames[0]), two = pose(root, said.frames[1]);
    const auto in_root = [](const Pose& pose, const Vec3<T>& v) {
      return pose.turned(std::array<X, 3>{number(v[0]), number(v[1]), number(v[2])});
    };
    const Column axis = in_root(two, made.vectors[1]);
    return {dot(in_root(one, made.across[0]), axis), dot(in_root(one, made.across[1]), axis)};
  }

  std::vector<X> align(const Scene::Closure& said) const {
    const int root = parting(said.frames[0], said.frames[1]);
    const Pose a = pose(root, said.frames[0]), b = pose(root, said.frames[1]);
    const auto R = [&](std::size_t i, std::size_t j) { return dot(a.axes[i], b.axes[j]); };
    const X half = number(T(0.5));
    return {(R(2, 1) - R(1, 2)) * half, (R(0, 2) - R(2, 0)) * half, (R(1, 0) - R(0, 1)) * half};
  }

  const Model<T>& model_;
  const Along& along_;
  const Lookup& symbol_;
};

}  // namespace mixloop
