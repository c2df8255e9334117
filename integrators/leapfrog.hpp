// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// Drift, kick, drift: order 2, one evaluation a step and one more at a piece's first.
///   q_m = q + h/2 v,  v_m = v + h/2 a',  a = a(q_m, v_m),  v+ = v + h a,  q+ = q_m + h/2 v+
/// a' is the acceleration of the step before (at the first step a(q_m, v)): it only has a share in forces
/// that depend on the velocity, and keeps the order there. Without such forces it is the position Verlet
/// scheme, symplectic (Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.4). Stable for
/// oscillations up to h omega = 2; dampers up to h lambda = -1 over many steps of a piece, -2 for a lone
/// step.
template <class T>
class Leapfrog {
 public:
  /// Of states (q, v, rest), n numbers of q, `size` in all.
  Leapfrog(Eigen::Index n, Eigen::Index size) : n_(n), middle_(size), dx_(size), a_(Vec<T>::Zero(n)) {}

  /// Forgets the step before: what follows starts afresh.
  void begin() { fresh_ = true; }

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h; one stage, c = 1/2.
  template <class Rate>
  void step(Vec<T>& x, const T& h, const Rate& rate) {
    middle_ = x;
    middle_.head(n_) += (h / 2) * x.segment(n_, n_);
    if (fresh_) {
      rate(0, T(0.5), middle_, dx_);
      a_ = dx_.segment(n_, n_);
      fresh_ = false;
    }
    middle_.segment(n_, n_) += (h / 2) * a_;
    rate(0, T(0.5), middle_, dx_);
    a_ = dx_.segment(n_, n_);
    const auto rest = x.size() - n_;
    x.tail(rest) += h * dx_.tail(rest);
    x.head(n_) = middle_.head(n_) + (h / 2) * x.segment(n_, n_);
  }

 private:
  Eigen::Index n_;
  Vec<T> middle_, dx_, a_;
  bool fresh_ = true;
};

}  // namespace mixloop
