// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "integrators/rosenbrock.hpp"

namespace mixloop {

/// Three motions in closed form, whose forces depend on position, velocity and time, nonlinearly:
///   q1 = tan t              q1'' = 2 q1 q1'
///   q2 = e^-t sin t         q2'' = -2 q2' - 2 q2
///   q3 = e^(-t^2/2)         q3'' = -q3 - t q3'
/// The state is (q, q', w) with w' = q1', so w = q1.
template <class T>
struct KnownMotion {
  static constexpr Eigen::Index kN = 3, kSize = 7;

  static Vec<T> at(const T& t) {
    using std::cos, std::exp, std::sin, std::tan;
    const T s = exp(-t) * sin(t), c = exp(-t) * cos(t), g = exp(-t * t / T(2)), u = tan(t);
    Vec<T> x(kSize);
    x << u, s, g, T(1) + u * u, c - s, -t * g, u;
    return x;
  }

  static void rate(const T& t, const Vec<T>& x, Vec<T>& dx) {
    dx.head(3) = x.segment(3, 3);
    dx[3] = T(2) * x[0] * x[3];
    dx[4] = -T(2) * x[4] - T(2) * x[1];
    dx[5] = -x[2] - t * x[5];
    dx[6] = x[3];
  }

  static void linearise(const T& t, const Vec<T>& x, AccelerationJacobian<T>& J) {
    J.by_q.setConstant(T(0));
    J.by_v.setConstant(T(0));
    J.by_q(0, 0) = T(2) * x[3];
    J.by_v(0, 0) = T(2) * x[0];
    J.by_q(1, 1) = J.by_v(1, 1) = T(-2);
    J.by_q(2, 2) = T(-1);
    J.by_v(2, 2) = -t;
    J.by_t << T(0), T(0), -x[5];
  }
};

/// A step of any method from time t on.
template <class Method, class T>
void step_known(Method& method, const T& t, const T& h, Vec<T>& x) {
  const auto rate = [&](int, const T& c, const Vec<T>& at, Vec<T>& dx) {
    KnownMotion<T>::rate(t + c * h, at, dx);
  };
  if constexpr (requires { Method::Table::kGamma; })
    method.step(x, h, rate, [&](const Vec<T>& at, auto& J) { KnownMotion<T>::linearise(t, at, J); });
  else
    method.step(x, h, rate);
}

}  // namespace mixloop
