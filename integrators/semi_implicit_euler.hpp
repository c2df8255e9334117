// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// v+ = v + h a(q, v), q+ = q + h v+: order 1, one evaluation a step, symplectic where forces depend on the
/// position alone (Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.2). Stable for oscillations
/// up to h omega = 2; dampers, taken explicitly, up to h lambda = -2.
template <class T>
class SemiImplicitEuler {
 public:
  /// Of states (q, v, rest), n numbers of q, `size` in all.
  SemiImplicitEuler(Eigen::Index n, Eigen::Index size) : n_(n), dx_(size) {}

  void begin() {}

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h; one stage, c = 0.
  template <class Rate>
  void step(Vec<T>& x, const T& h, const Rate& rate) {
    rate(0, T(0), x, dx_);
    const auto rest = x.size() - n_;
    x.tail(rest) += h * dx_.tail(rest);
    x.head(n_) += h * x.segment(n_, n_);
  }

 private:
  Eigen::Index n_;
  Vec<T> dx_;
};

}  // namespace mixloop
