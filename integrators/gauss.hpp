// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// Nodes and weights of Gauss-Legendre collocation on [0, 1] and the integrals a_ij of its Lagrange
/// polynomials from 0 to c_i (Hairer & Wanner, Solving ODEs II, IV.5), worked out in T.
template <class T, std::size_t S>
struct GaussTable {
  std::array<T, S> c, b;
  std::array<std::array<T, S>, S> a;
  std::array<std::array<T, S>, S> ahead;  ///< l_j(1 + c_i): the polynomial carried into the next step

  GaussTable() {
    for (std::size_t i = 0; i < S; ++i) node(i);
    for (std::size_t i = 0; i < S; ++i)
      for (std::size_t j = 0; j < S; ++j) {
        // a_ij = int_0^c_i l_j, by the S nodes themselves: exact for degree 2 S - 1
        T sum(0);
        for (std::size_t m = 0; m < S; ++m) sum += b[m] * lagrange(j, c[i] * c[m]);
        a[i][j] = c[i] * sum;
        ahead[i][j] = lagrange(j, T(1) + c[i]);
      }
  }

  T lagrange(std::size_t j, const T& x) const {
    T value(1);
    for (std::size_t m = 0; m < S; ++m)
      if (m != j) value *= (x - c[m]) / (c[j] - c[m]);
    return value;
  }

 private:
  /// The root of Legendre's P_S by Newton, and its weight 1 / ((1 - x^2) P_S'(x)^2) on [0, 1].
  void node(std::size_t i) {
    constexpr double kPi = 3.14159265358979323846;
    const auto s = static_cast<double>(S);
    T x(-std::cos(kPi * (static_cast<double>(i) + 0.75) / (s + 0.5))), slope(0);
    for (int iteration = 0; iteration < 12; ++iteration) {
      T p(1), before(0);
      for (std::size_t k = 1; k <= S; ++k) {
        const T next = ((T(2 * static_cast<int>(k) - 1)) * x * p - T(static_cast<int>(k) - 1) * before) /
                       T(static_cast<int>(k));
        before = p;
        p = next;
      }
      slope = T(static_cast<int>(S)) * (x * p - before) / (x * x - T(1));
      x -= p / slope;
    }
    c[i] = (T(1) + x) / T(2);
    b[i] = T(1) / ((T(1) - x * x) * slope * slope);
  }
};

/// Collocation at S Gauss points: order 2 S, symmetric, A-stable by its formula; its equations are solved by
/// fixed-point iteration on the accelerations, which with S = 4 converges to h omega = 4.8 and, of a damper,
/// h lambda = -3.6; past that the step gives what is not a number. It takes as many sweeps of S evaluations
/// as round-off asks for, at most kMostSweeps. For long runs that must not drift, and for wide floats (any
/// order). Hairer, Lubich & Wanner, Geometric Numerical Integration, II.1.3, VIII.6.
template <class T, std::size_t S>
class Gauss {
 public:
  static constexpr std::size_t kStages = S;
  static constexpr int kOrder = static_cast<int>(2 * S), kMostSweeps = 60;

  /// Of states (q, v, rest), n numbers of q, `size` in all.
  Gauss(Eigen::Index n, Eigen::Index size) : n_(n), x_(size) {
    for (auto& dx : dx_) dx = Vec<T>::Zero(size);
    for (auto* set : {&A_, &V_, &predicted_})
      for (auto& values : *set) values = Vec<T>::Zero(n);
  }

  /// Forgets the step before, whose polynomial starts the iteration.
  void begin() { fresh_ = true; }

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h.
  template <class Rate>
  void step(Vec<T>& x, const T& h, const Rate& rate) {
    solve(x, h, rate);
    const auto rest = x.size() - 2 * n_;
    for (Eigen::Index r = 0; r < n_; ++r) {
      x[r] += h * weighted(V_, r);
      x[n_ + r] += h * weighted(A_, r);
    }
    for (Eigen::Index r = x.size() - rest; r < x.size(); ++r) x[r] += h * weighted(dx_, r);
  }

  /// As step, what is rounded away kept in `carry` and given back at the next step.
  template <class Rate>
  void compensated_step(Vec<T>& x, Vec<T>& carry, const T& h, const Rate& rate) {
    solve(x, h, rate);
    const auto add = [&](Eigen::Index r, const T& change) {
      const T increment = carry[r] + change, before = x[r];
      x[r] += increment;
      carry[r] = increment - (x[r] - before);
    };
    for (Eigen::Index r = 0; r < n_; ++r) {
      add(r, h * weighted(V_, r));
      add(n_ + r, h * weighted(A_, r));
    }
    for (Eigen::Index r = 2 * n_; r < x.size(); ++r) add(r, h * weighted(dx_, r));
  }

  /// Sweeps of the last step.
  int sweeps() const { return sweeps_; }

  static const GaussTable<T, S>& table() {
    static const GaussTable<T, S> table;
    return table;
  }

 private:
  template <class Values>
  T weighted(const Values& values, Eigen::Index r) const {
    T sum = table_.b[0] * values[0][r];
    for (std::size_t i = 1; i < S; ++i) sum += table_.b[i] * values[i][r];
    return sum;
  }

  /// V_i = v + h sum a_ij A_j, Q_i = q + h sum a_ij V_j, A_i = a(Q_i, V_i), until the A_i change no more.
  template <class Rate>
  void solve(const Vec<T>& x, const T& h, const Rate& rate) {
    predict(x, rate);
    const T roundoff = std::numeric_limits<T>::epsilon();
    T before(0);
    for (sweeps_ = 1; sweeps_ <= kMostSweeps; ++sweeps_) {
      const T change = sweep(x, h, rate);
      if (!(change > roundoff / T(8))) return;                                    // at rest
      if (sweeps_ > 2 && change >= before && change < T(1e7) * roundoff) return;  // the rest is rounding
      before = change;
    }
    for (auto* set : {&A_, &V_})
      for (auto& values : *set) values.setConstant(std::numeric_limits<T>::quiet_NaN());
  }

  template <class Rate>
  void predict(const Vec<T>& x, const Rate& rate) {
    if (fresh_) {
      rate(0, table_.c[0], x, dx_[0]);
      for (auto& A : A_) A = dx_[0].segment(n_, n_);
      fresh_ = false;
      return;
    }
    for (std::size_t i = 0; i < S; ++i) {
      predicted_[i].setConstant(T(0));
      for (std::size_t j = 0; j < S; ++j) predicted_[i] += table_.ahead[i][j] * A_[j];
    }
    for (std::size_t i = 0; i < S; ++i) A_[i] = predicted_[i];
  }

  /// The largest change of an acceleration, as a share of the largest.
  template <class Rate>
  T sweep(const Vec<T>& x, const T& h, const Rate& rate) {
    using std::abs;
    for (std::size_t i = 0; i < S; ++i)
      for (Eigen::Index r = 0; r < n_; ++r) {
        T sum = table_.a[i][0] * A_[0][r];
        for (std::size_t j = 1; j < S; ++j) sum += table_.a[i][j] * A_[j][r];
        V_[i][r] = x[n_ + r] + h * sum;
      }
    T change(0), largest(0);
    x_ = x;
    for (std::size_t i = 0; i < S; ++i) {
      for (Eigen::Index r = 0; r < n_; ++r) {
        T sum = table_.a[i][0] * V_[0][r];
        for (std::size_t j = 1; j < S; ++j) sum += table_.a[i][j] * V_[j][r];
        x_[r] = x[r] + h * sum;
        x_[n_ + r] = V_[i][r];
      }
      rate(static_cast<int>(i), table_.c[i], x_, dx_[i]);
    }
    for (std::size_t i = 0; i < S; ++i)
      for (Eigen::Index r = 0; r < n_; ++r) {
        const T moved = abs(dx_[i][n_ + r] - A_[i][r]), size = abs(dx_[i][n_ + r]);
        if (!(moved >= T(0))) return moved;  // not a number
        if (moved > change) change = moved;
        if (size > largest) largest = size;
        A_[i][r] = dx_[i][n_ + r];
      }
    return change > T(0) ? change / largest : change;
  }

  const GaussTable<T, S>& table_ = table();
  Eigen::Index n_;
  Vec<T> x_;
  std::array<Vec<T>, S> dx_, A_, V_, predicted_;
  bool fresh_ = true;
  int sweeps_ = 0;
};

}  // namespace mixloop
