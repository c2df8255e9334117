// SPDX-License-Identifier: MIT
#include "planner/cycloid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "notation/functions/sincos.hpp"

namespace mixloop {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

/// y - sin y without cancellation: near zero y^3/3! - y^5/5! + ..., to round-off for y < 1.
double minus_sine(double y) {
  if (y >= 1) return y - mixloop_functions::sin(y);
  double sum = 0;
  for (int k = 19; k >= 3; k -= 2) sum = (1 - sum) * y * y / (k * (k - 1));
  return y * sum;
}

}  // namespace

Displacement cycloid(double x, double S_T, double T_T) {
  x = std::clamp(x, 0.0, 1.0);
  const double from_nearer_end = x <= 0.5 ? x : 1 - x;  // 1 - x is exact there
  const double y = kTwoPi * from_nearer_end;
  const double part = minus_sine(y) / kTwoPi;
  const double half = mixloop_functions::sin(y / 2);
  const double sdd = kTwoPi * S_T / (T_T * T_T) * mixloop_functions::sin(y);
  return {.s = S_T * (x <= 0.5 ? part : 1 - part),
          .sd = S_T / T_T * (2 * half * half),  // 1 - cos y
          .sdd = x <= 0.5 ? sdd : -sdd};
}

}  // namespace mixloop
