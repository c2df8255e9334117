// SPDX-License-Identifier: MIT
#pragma once

namespace mixloop {

/// A displacement along a path with its first and second time derivative.
struct Displacement {
  double s = 0;    ///< m
  double sd = 0;   ///< m/s
  double sdd = 0;  ///< m/s^2
};

/// (34) s = S_T (x - sin(2 pi x) / (2 pi)) at x = t / T_T in [0, 1], with its exact derivatives; to round-off
/// relative to each value, also where it nearly vanishes: at both ends sd and sdd are exactly zero.
/// Outside [0, 1] the nearer end's values.
Displacement cycloid(double x, double S_T, double T_T);

}  // namespace mixloop
