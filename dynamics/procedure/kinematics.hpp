// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/workspace.hpp"

namespace mixloop {

namespace detail {

/// What may vary of a transform.
template <class T>
struct Varying {
  T cosine, sine;  ///< of theta
  T s;
};

template <class T>
Varying<T> varying(const typename Model<T>::Link& link, const Vec<T>& q) {
  using mixloop_functions::cos, mixloop_functions::sin;
  Varying<T> now{link.cos_theta, link.sin_theta, link.s};
  if (link.coordinate >= 0 && link.prismatic) now.s = link.scale * q[link.coordinate] + link.s;
  if (link.coordinate >= 0 && !link.prismatic) {
    const T theta = link.scale * q[link.coordinate] + link.theta;
    now.cosine = cos(theta);
    now.sine = sin(theta);
  }
  return now;
}

/// upper three rows.
template <class T>
Mat34<T> transform(const typename Model<T>::Link& link, const Vec<T>& q) {
  const auto [c, s, d] = varying<T>(link, q);
  Mat34<T> A;
  A << c, -(s * link.cos_alpha), s * link.sin_alpha, link.a * c,  //
      s, c * link.cos_alpha, -(c * link.sin_alpha), link.a * s,   //
      T(0), link.sin_alpha, link.cos_alpha, d;
  return A;
}

/// B A, upper three rows; the fourth is zero.
template <class T>
Mat34<T> varied(const Mat34<T>& A, bool prismatic) {
  Mat34<T> BA;
  if (prismatic)  // B(2,3) = 1
    BA << T(0), T(0), T(0), T(0), T(0), T(0), T(0), T(0), T(0), T(0), T(0), T(1);
  else  // B(0,1) = -1, B(1,0) = 1
    BA << -A.row(1), A.row(0), T(0), T(0), T(0), T(0);
  return BA;
}

/// B^2 A: diag(-1, -1, 0, 0) A for a revolute pair (a prismatic one has none).
template <class T>
Mat34<T> varied_twice(const Mat34<T>& A) {
  Mat34<T> BBA;
  BBA << -A.row(0), -A.row(1), T(0), T(0), T(0), T(0);
  return BBA;
}

/// X A for a transform A, whose fourth row is (0 0 0 1).
template <class T>
Mat34<T> times_transform(const Mat34<T>& X, const Mat34<T>& A) {
  Mat34<T> product = X.template leftCols<3>().lazyProduct(A);
  product.col(3) += X.col(3);
  return product;
}

/// X Y for a derivative Y, whose fourth row is zero.
template <class T>
Mat34<T> times_derivative(const Mat34<T>& X, const Mat34<T>& Y) {
  return X.template leftCols<3>().lazyProduct(Y);
}

/// The vector of a skew-symmetric matrix, as (10) and (18) lay it out.
template <class T, class Derived>
Vec3<T> vector_of_skew(const Eigen::MatrixBase<Derived>& skew) {
  return Vec3<T>(skew(2, 1), skew(0, 2), skew(1, 0));
}

template <class T>
Mat3<T> skew_of_vector(const Vec3<T>& w) {
  Mat3<T> skew;
  skew << T(0), -w[2], w[1], w[2], T(0), -w[0], -w[1], w[0], T(0);
  return skew;
}

}  // namespace detail

/// (6), (8): [T]_0^i and [V]_j of every frame from ws.q, each from its parent's.
template <class T>
void frame_variations(const Model<T>& model, Workspace<T>& ws) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& link = model.links[i];
    const auto& parent = ws.frames[static_cast<std::size_t>(link.parent)];
    const auto& parent_path = model.path(link.parent);
    auto& frame = ws.frames[i + 1];
    const Mat34<T> A = detail::transform<T>(link, ws.q);
    frame.T_0 = detail::times_transform<T>(parent.T_0, A);
    std::size_t above = 0;
    for (std::size_t j = 0; j < link.path.size(); ++j) {
      const bool inherited = above < parent_path.size() && parent_path[above] == link.path[j];
      if (inherited) frame.V[j] = detail::times_transform<T>(parent.V[above++], A);
      if (link.path[j] != link.coordinate) continue;
      const Mat34<T> own =
          detail::times_derivative<T>(parent.T_0, detail::varied<T>(A, link.prismatic)) * link.scale;
      frame.V[j] = inherited ? Mat34<T>(frame.V[j] + own) : own;
    }
  }
}

// Compiled once for double, in procedure.cpp.
extern template void frame_variations(const Model<double>&, Workspace<double>&);

/// (12), (13): [T']_0^i = sum_j q'_j [V]_j and sum_j q'_j [V']_j of every frame from ws.q and ws.qd; the
/// double sum of (13) as a recursion along the tree.
template <class T>
void frame_rates(const Model<T>& model, Workspace<T>& ws) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const auto& link = model.links[i];
    const auto& parent = ws.frames[static_cast<std::size_t>(link.parent)];
    auto& frame = ws.frames[i + 1];
    const Mat34<T> A = detail::transform<T>(link, ws.q);
    frame.Td = detail::times_transform<T>(parent.Td, A);
    frame.Tdd_bias = detail::times_transform<T>(parent.Tdd_bias, A);
    if (link.coordinate < 0) continue;
    const T rate = link.scale * ws.qd[link.coordinate];
    const Mat34<T> BA = detail::varied<T>(A, link.prismatic);
    frame.Td += detail::times_derivative<T>(parent.T_0, BA) * rate;
    frame.Tdd_bias += detail::times_derivative<T>(parent.Td, BA) * (T(2) * rate);
    if (!link.prismatic)
      frame.Tdd_bias += detail::times_derivative<T>(parent.T_0, detail::varied_twice<T>(A)) * (rate * rate);
  }
}

/// (5): a point's place, or with [V]_j, [T'] or [T''] for the frame, its variation (7), rate or (16).
template <class T>
Vec3<T> at_point(const Mat34<T>& X, const Vec3<T>& point) {
  return X.template leftCols<3>().lazyProduct(point) + X.col(3);
}

/// (9): the linear displacement variations of a point, column j for coordinate path[j] of the frame.
template <class T, class Out>
void linear_variations(const typename Workspace<T>::Frame& frame, const Vec3<T>& point, Out&& D) {
  for (std::size_t j = 0; j < frame.V.size(); ++j)
    D.col(static_cast<Eigen::Index>(j)) = at_point<T>(frame.V[j], point);
}

/// (10), (11): the angular displacement variations in the frame's own axes.
template <class T, class Out>
void angular_variations(const typename Workspace<T>::Frame& frame, Out&& O) {
  for (std::size_t j = 0; j < frame.V.size(); ++j) {
    const auto& V = frame.V[j];
    const auto& R = frame.T_0;
    // Only three elements of [T]^T [V] are needed.
    O(0, static_cast<Eigen::Index>(j)) = R.col(2).dot(V.col(1));
    O(1, static_cast<Eigen::Index>(j)) = R.col(0).dot(V.col(2));
    O(2, static_cast<Eigen::Index>(j)) = R.col(1).dot(V.col(0));
  }
}

}  // namespace mixloop
