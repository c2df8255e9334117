// SPDX-License-Identifier: MIT
// Linkages in one plane by Lagrange's equations of the first kind: all angles are coordinates, the loops are
// equations with multipliers, nothing is solved for but accelerations. A point is written as publications
// write it, a sum of vectors that have turned by sums of angles. Motions by Gragg's extrapolation, which
// shares no table with integrators/.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace mixloop::oracle {

/// (x, y), turned by the sum of `by`[i] times angle i.
template <class T>
struct Turned {
  std::vector<int> by;
  T x{}, y{};
};

/// A fixed place and what turned vectors add to it.
template <class T>
struct LinkagePoint {
  T x{}, y{};
  std::vector<Turned<T>> arms;
};

/// A body turns as `by` says; its inertia is about its centre of mass.
template <class T>
struct LinkageBody {
  T mass{}, inertia{};
  std::vector<int> by;
  LinkagePoint<T> centre;
};

/// From a moving point to a fixed place.
template <class T>
struct LinkageSpring {
  LinkagePoint<T> from;
  T to_x{}, to_y{}, stiffness{}, rest{};
};

template <class T>
struct Linkage {
  int angles = 0;
  std::vector<LinkageBody<T>> bodies;
  std::vector<LinkagePoint<T>> loops;  ///< each at (0, 0) where its loop closes
  std::vector<LinkageSpring<T>> springs;
  T gravity{};  ///< along -y
};

template <class T>
using LinkageVector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

/// Where a point is, its Jacobian over the angles, and the part of its acceleration that has no q''.
template <class T>
struct PointMotion {
  Eigen::Matrix<T, 2, 1> p, bias;
  Eigen::Matrix<T, 2, Eigen::Dynamic> J;
};

template <class T>
T turned_by(const std::vector<int>& by, const LinkageVector<T>& q) {
  T sum = 0;
  for (std::size_t i = 0; i < by.size(); ++i) sum += by[i] * q[static_cast<Eigen::Index>(i)];
  return sum;
}

template <class T>
PointMotion<T> motion_of(const LinkagePoint<T>& point, const LinkageVector<T>& q,
                         const LinkageVector<T>& qd) {
  using std::cos;
  using std::sin;
  PointMotion<T> m;
  m.p << point.x, point.y;
  m.bias.setZero();
  m.J.setZero(2, q.size());
  for (const auto& arm : point.arms) {
    const T angle = turned_by(arm.by, q), rate = turned_by(arm.by, qd), c = cos(angle), s = sin(angle);
    const T x = c * arm.x - s * arm.y, y = s * arm.x + c * arm.y;
    m.p[0] += x, m.p[1] += y;
    m.bias[0] -= rate * rate * x, m.bias[1] -= rate * rate * y;
    for (std::size_t i = 0; i < arm.by.size(); ++i) {
      m.J(0, static_cast<Eigen::Index>(i)) -= arm.by[i] * y;
      m.J(1, static_cast<Eigen::Index>(i)) += arm.by[i] * x;
    }
  }
  return m;
}

/// q'' under `torque` on each angle: M q'' + G^T lambda = f, G q'' = -G' q'.
template <class T>
LinkageVector<T> linkage_accelerations(const Linkage<T>& linkage, const LinkageVector<T>& q,
                                       const LinkageVector<T>& qd, const LinkageVector<T>& torque) {
  using std::sqrt;
  const Eigen::Index n = linkage.angles, rows = 2 * static_cast<Eigen::Index>(linkage.loops.size());
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> A;
  A.setZero(n + rows, n + rows);
  LinkageVector<T> right = LinkageVector<T>::Zero(n + rows);
  right.head(n) = torque;
  for (const auto& body : linkage.bodies) {
    auto m = motion_of(body.centre, q, qd);
    A.topLeftCorner(n, n) += body.mass * m.J.transpose() * m.J;
    m.bias[1] += linkage.gravity;
    right.head(n) -= body.mass * m.J.transpose() * m.bias;
    for (std::size_t i = 0; i < body.by.size(); ++i)
      for (std::size_t j = 0; j < body.by.size(); ++j)
        A(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
            body.inertia * body.by[i] * body.by[j];
  }
  for (const auto& spring : linkage.springs) {
    const auto m = motion_of(spring.from, q, qd);
    const Eigen::Matrix<T, 2, 1> r(m.p[0] - spring.to_x, m.p[1] - spring.to_y);
    const T length = sqrt(r.dot(r));
    right.head(n) -= m.J.transpose() * (spring.stiffness * (length - spring.rest) / length * r);
  }
  for (std::size_t k = 0; k < linkage.loops.size(); ++k) {
    const auto m = motion_of(linkage.loops[k], q, qd);
    const auto row = n + 2 * static_cast<Eigen::Index>(k);
    A.block(row, 0, 2, n) = m.J;
    A.block(0, row, n, 2) = m.J.transpose();
    right.segment(row, 2) = -m.bias;
  }
  const LinkageVector<T> x = A.partialPivLu().solve(right);
  return x.head(n);
}

/// By how much the loops are open, a row each.
template <class T>
LinkageVector<T> openings(const Linkage<T>& linkage, const LinkageVector<T>& q) {
  LinkageVector<T> open(2 * static_cast<Eigen::Index>(linkage.loops.size()));
  for (std::size_t k = 0; k < linkage.loops.size(); ++k)
    open.segment(2 * static_cast<Eigen::Index>(k), 2) = motion_of(linkage.loops[k], q, q).p;
  return open;
}

/// Closes the loops by Newton's method over all angles but the first; as many loop rows as those.
template <class T>
void close(const Linkage<T>& linkage, LinkageVector<T>& q, int times = 8) {
  const Eigen::Index n = linkage.angles;
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> G(n - 1, n - 1);
  for (int time = 0; time < times; ++time) {
    for (std::size_t k = 0; k < linkage.loops.size(); ++k)
      G.middleRows(2 * static_cast<Eigen::Index>(k), 2) =
          motion_of(linkage.loops[k], q, q).J.rightCols(n - 1);
    q.tail(n - 1) -= G.partialPivLu().solve(openings(linkage, q));
  }
}

/// The rates that keep the loops closed where the first angle turns by `rate`.
template <class T>
LinkageVector<T> closed_rates(const Linkage<T>& linkage, const LinkageVector<T>& q, const T& rate) {
  const Eigen::Index n = linkage.angles;
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> G(n - 1, n);
  for (std::size_t k = 0; k < linkage.loops.size(); ++k)
    G.middleRows(2 * static_cast<Eigen::Index>(k), 2) = motion_of(linkage.loops[k], q, q).J;
  LinkageVector<T> qd(n);
  qd[0] = rate;
  qd.tail(n - 1) = -G.rightCols(n - 1).partialPivLu().solve(G.col(0) * rate);
  return qd;
}

/// x(t + h) of x' = f(x): the modified midpoint rule in 2, 4, ... 2 `columns` steps, extrapolated in h^2 to
/// order 2 `columns` (Hairer, Norsett & Wanner, Solving ODEs I, II.9).
template <class T, class Rate>
LinkageVector<T> extrapolated(const LinkageVector<T>& x, const T& h, int columns, const Rate& f) {
  std::vector<LinkageVector<T>> table;
  const LinkageVector<T> slope = f(x);
  for (int j = 1; j <= columns; ++j) {
    const int steps = 2 * j;
    const T part = h / steps;
    LinkageVector<T> before = x, now = x + part * slope;
    for (int step = 1; step < steps; ++step) {
      LinkageVector<T> next = before + 2 * part * f(now);
      before = std::move(now), now = std::move(next);
    }
    table.push_back((before + now + part * f(now)) / 2);
    for (int k = j - 1; k >= 1; --k) {
      const T ratio = T(j) / T(k);
      const auto at = static_cast<std::size_t>(k) - 1;
      table[at] = table[at + 1] + (table[at + 1] - table[at]) / (ratio * ratio - 1);
    }
  }
  return table[0];
}

/// (q, q') after `duration` in `steps` extrapolated steps, `torque` on the angles all the while.
template <class T>
LinkageVector<T> linkage_motion(const Linkage<T>& linkage, LinkageVector<T> q, LinkageVector<T> qd,
                                const LinkageVector<T>& torque, const T& duration, int steps, int columns) {
  const Eigen::Index n = linkage.angles;
  LinkageVector<T> x(2 * n);
  x << q, qd;
  for (int step = 0; step < steps; ++step)
    x = extrapolated(x, T(duration / steps), columns, [&](const LinkageVector<T>& at) {
      LinkageVector<T> rate(2 * n);
      q = at.head(n), qd = at.tail(n);
      rate << qd, linkage_accelerations(linkage, q, qd, torque);
      return rate;
    });
  return x;
}

}  // namespace mixloop::oracle
