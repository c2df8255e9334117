// SPDX-License-Identifier: MIT
// Sine and cosine together, branch-free in the common range and vectorisable; the same bits on every
// machine with IEEE doubles, as long as products and sums are not contracted (-ffp-contract=off).
// This text also goes into every emitted program, so it stands alone: C++17 and <math.h>.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

namespace mixloop_sincos {

// pi/2 in three parts (Cody and Waite): k * kHigh and k * kMiddle are exact for |k| < 2^20.
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr double kHigh = 0x1.921fb544p+0;
constexpr double kMiddle = 0x1.0b4611a6p-34;
constexpr double kLow = 0x1.3198a2e037073p-69;
constexpr double kLimit = 0x1p+20;   // beyond it, the C library's
constexpr double kRound = 0x1.8p+52; // adding it rounds to the nearest whole number, kept in the low bits

// sin r = r + r^3 (S0 + S1 r^2 + ...), |r| <= pi/4; FreeBSD's coefficients, error below 2^-58.
template <class Real>
inline Real sine_kernel(Real r, Real z) {
  const Real z2 = z * z;
  const Real p = (-0x1.5555555555549p-3 + z * 0x1.111111110f8a6p-7) +
                 z2 * ((-0x1.a01a019c161d5p-13 + z * 0x1.71de357b1fe7dp-19) +
                       z2 * (-0x1.ae5e68a2b9cebp-26 + z * 0x1.5d93a5acfd57cp-33));
  return r + (r * z) * p;
}

// cos r = 1 - r^2/2 + r^4 (C0 + C1 r^2 + ...), what 1 - r^2/2 rounds away put back.
template <class Real>
inline Real cosine_kernel(Real z) {
  const Real z2 = z * z;
  const Real p = (0x1.555555555554cp-5 + z * -0x1.6c16c16c15177p-10) +
                 z2 * ((0x1.a01a019cb159p-16 + z * -0x1.27e4f809c52adp-22) +
                       z2 * (0x1.1ee9ebdb4b1c4p-29 + z * -0x1.8fae9be8838d4p-37));
  const Real half = 0.5 * z;
  const Real w = 1.0 - half;
  return w + (((1.0 - w) - half) + z2 * p);
}

/// Largest error seen over 1e8 seeded angles, |x| <= 1e6: 0.9 units in the last place.
inline void sincos(double x, double* sine, double* cosine) {
  if (!(x < kLimit && x > -kLimit)) {
    *sine = sin(x);
    *cosine = cos(x);
    return;
  }
  const double shifted = x * kTwoOverPi + kRound;
  const double k = shifted - kRound;
  const double r = ((x - k * kHigh) - k * kMiddle) - k * kLow;
  const double z = r * r;
  const double s = sine_kernel(r, z), c = cosine_kernel(z);
  uint64_t quadrant, u, v;
  memcpy(&quadrant, &shifted, sizeof quadrant);
  memcpy(&u, &s, sizeof u);
  memcpy(&v, &c, sizeof v);
  // Odd quadrants swap sine and cosine; the sine turns in quadrants 2 and 3, the cosine in 1 and 2.
  const uint64_t swapped = (u ^ v) & (0 - (quadrant & 1));
  u ^= swapped ^ ((quadrant & 2) << 62);
  v ^= swapped ^ (((quadrant + 1) & 2) << 62);
  memcpy(sine, &u, sizeof u);
  memcpy(cosine, &v, sizeof v);
}

}  // namespace mixloop_sincos
