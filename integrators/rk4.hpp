// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// The classical Runge-Kutta method: order 4, four evaluations a step. Stable for h lambda in [-2.7853, 0]
/// and i [-2.8284, 2.8284]. Hairer, Norsett & Wanner, Solving ODEs I, II.1, table 1.2.
template <class T>
class Rk4 {
 public:
  Rk4(Eigen::Index, Eigen::Index size) : k1_(size), k2_(size), k3_(size), k4_(size), x_(size) {}

  void begin() {}

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h; stages count 0, 1, 2, 3, with c = 0, 1/2,
  /// 1/2, 1.
  template <class Rate>
  void step(Vec<T>& x, const T& h, const Rate& rate) {
    rate(0, T(0), x, k1_);
    go(x, h / 2, k1_);
    rate(1, T(0.5), x_, k2_);
    go(x, h / 2, k2_);
    rate(2, T(0.5), x_, k3_);
    go(x, h, k3_);
    rate(3, T(1), x_, k4_);
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] += (h / 6) * (k1_[i] + T(2) * k2_[i] + T(2) * k3_[i] + alone(k4_[i]));
  }

 private:
  void go(const Vec<T>& x, const T& h, const Vec<T>& k) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x_[i] = x[i] + h * alone(k[i]);
  }

  /// A number loaded by itself: programs store rates one by one, and what loads two of them together waits
  /// until both have left the processor.
  static T alone(const T& x) {
    if constexpr (std::is_same_v<T, double>)
      return *static_cast<const volatile double*>(&x);
    else
      return x;
  }

  Vec<T> k1_, k2_, k3_, k4_, x_;
};

}  // namespace mixloop
