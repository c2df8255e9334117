// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// The size of an error e of states (q, v, rest): the largest |e_i| / (1 + |x_i|) over q and v. What
/// `local_error` bounds: absolute for small numbers, relative for large ones.
template <class T>
T error_size(const Vec<T>& e, const Vec<T>& x, Eigen::Index n) {
  using std::abs;
  T largest(0);
  for (Eigen::Index r = 0; r < 2 * n; ++r) {
    const T size = abs(e[r]) / (T(1) + abs(x[r]));
    if (!(size >= T(0))) return size;  // not a number
    if (size > largest) largest = size;
  }
  return largest;
}

/// What an error-controlled piece took.
struct StepCount {
  int accepted = 0, rejected = 0;
  bool finished = false;  ///< false: it would take more than `most` steps, or nothing finite came out
};

/// Integrates x over `length` in steps that keep the estimated error of each below `tolerance` (Hairer,
/// Norsett & Wanner, Solving ODEs I, II.4: h' = 0.9 h (tolerance / error)^(1/q), a factor of 0.2 to 6).
/// `rate(t, x, dx)` has t from the piece's start. Starts afresh with the whole length as its first step; the
/// steps end on `length`.
template <class Method, class T, class Rate>
StepCount controlled_steps(Method& method, Vec<T>& x, Eigen::Index n, const T& length, const T& tolerance,
                           int most, const Rate& rate) {
  using std::pow;
  StepCount count;
  const double order = Method::kOrder;
  T t(0), h = length;
  bool rejected = false;
  const auto at = [&](int, const T& c, const Vec<T>& state, Vec<T>& dx) { rate(t + c * h, state, dx); };
  method.first_stage(x, at);
  while (count.accepted + count.rejected < most) {
    const bool last = t + h * T(1.0000001) >= length;
    if (last) h = length - t;
    method.try_step(x, h, at);
    method.last_stage(at);
    const T error = method.error(h, [&](const Vec<T>& e) { return error_size<T>(e, x, n); }) / tolerance;
    const double factor =
        error > T(0) ? 0.9 * pow(static_cast<double>(error), -1 / order) : (error == T(0) ? 6.0 : 0.2);
    if (error <= T(1)) {
      method.accept(x);
      t += h;
      ++count.accepted;
      if (last) {
        count.finished = true;
        return count;
      }
      h *= T(std::clamp(factor, 0.2, rejected ? 1.0 : 6.0));
      rejected = false;
    } else {
      ++count.rejected;
      rejected = true;
      h *= T(std::clamp(factor, 0.2, 0.9));
    }
  }
  return count;
}

}  // namespace mixloop
