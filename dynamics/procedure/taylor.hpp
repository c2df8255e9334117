// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {

/// A quantity along a line x(s) = x + s dx through the space of its arguments: value, first and second
/// derivative in s at s = 0. Arithmetic on it differentiates exactly (truncated Taylor series, Griewank &
/// Walther, Evaluating Derivatives, ch. 13). Along (psi', 1) in (psi, t) the second derivative of a
/// constraint is [C']{psi'} + F_tt, mixed term included.
template <class T>
struct Taylor {
  T v{};   ///< value
  T d{};   ///< first derivative
  T dd{};  ///< second derivative

  Taylor() : v(0), d(0), dd(0) {}
  explicit Taylor(const T& value) : v(value), d(0), dd(0) {}
  explicit Taylor(double value) requires(!std::is_same_v<T, double>) : v(value), d(0), dd(0) {}
  Taylor(const T& value, const T& first, const T& second) : v(value), d(first), dd(second) {}

  friend Taylor operator+(const Taylor& a, const Taylor& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
  friend Taylor operator-(const Taylor& a, const Taylor& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
  friend Taylor operator-(const Taylor& a) { return {-a.v, -a.d, -a.dd}; }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + T(2) * (a.d * b.d) + a.v * b.dd};
  }
  friend Taylor operator/(const Taylor& a, const Taylor& b) {
    const T v = a.v / b.v;
    const T d = (a.d - v * b.d) / b.v;
    return {v, d, (a.dd - T(2) * (d * b.d) - v * b.dd) / b.v};
  }

  friend Taylor sqrt(const Taylor& a) {
    using std::sqrt;
    const T v = sqrt(a.v);
    const T d = a.d / (T(2) * v);
    return {v, d, (a.dd / T(2) - d * d) / v};
  }
  friend Taylor sin(const Taylor& a) {
    using mixloop_functions::cos, mixloop_functions::sin;
    const T s = sin(a.v), c = cos(a.v);
    return {s, c * a.d, c * a.dd - s * (a.d * a.d)};
  }
  friend Taylor cos(const Taylor& a) {
    using mixloop_functions::cos, mixloop_functions::sin;
    const T s = sin(a.v), c = cos(a.v);
    return {c, -(s * a.d), -(s * a.dd) - c * (a.d * a.d)};
  }
  friend Taylor atan2(const Taylor& y, const Taylor& x) {
    using mixloop_functions::atan2;
    const T r2 = x.v * x.v + y.v * y.v;
    const T d = (x.v * y.d - y.v * x.d) / r2;
    const T r2d = T(2) * (x.v * x.d + y.v * y.d);
    return {atan2(y.v, x.v), d, (x.v * y.dd - y.v * x.dd - d * r2d) / r2};
  }
  friend Taylor exp(const Taylor& a) {
    using mixloop_functions::exp;
    const T v = exp(a.v);
    return {v, v * a.d, v * (a.dd + a.d * a.d)};
  }
  friend Taylor log(const Taylor& a) {
    using mixloop_functions::log;
    const T d = a.d / a.v;
    return {log(a.v), d, a.dd / a.v - d * d};
  }
};

}  // namespace mixloop
