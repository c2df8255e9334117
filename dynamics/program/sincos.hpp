// SPDX-License-Identifier: MIT
// Sine and cosine together, branch-free in the common range and vectorisable; the same bits on every
// machine with IEEE doubles, as long as products and sums are not contracted (-ffp-contract=off).
// This text also goes into every emitted program, so it stands alone: C++17 and <math.h>.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

// Inlined whatever its size: a call would take a good part of the time.
#if defined(__GNUC__)
#define MIXLOOP_INLINE inline __attribute__((always_inline))
#else
#define MIXLOOP_INLINE inline
#endif

namespace mixloop_sincos {

// pi/2 in three parts (Cody and Waite): k * kHigh and k * kMiddle are exact for |k| < 2^20.
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr double kHigh = 0x1.921fb544p+0;
constexpr double kMiddle = 0x1.0b4611a6p-34;
constexpr double kLow = 0x1.3198a2e037073p-69;
constexpr double kLimit = 0x1p+20;    // beyond it, the C library's
constexpr double kRound = 0x1.8p+52;  // adding it rounds to the nearest whole number, kept in the low bits

// sin r = r + r^3 (S0 + S1 r^2 + ...), |r| <= pi/4, z = r^2; FreeBSD's coefficients, error below 2^-58. In
// Estrin's order, whose chains are short.
// By reference, so that vectors meet no calling convention.
template <class Real>
MIXLOOP_INLINE void sine_kernel(const Real& r, const Real& z, Real& sine) {
  const Real z2 = z * z;
  const Real p = (-0x1.5555555555549p-3 + z * 0x1.111111110f8a6p-7) +
                 (z2 * (-0x1.a01a019c161d5p-13 + z * 0x1.71de357b1fe7dp-19) +
                  (z2 * z2) * (-0x1.ae5e68a2b9cebp-26 + z * 0x1.5d93a5acfd57cp-33));
  sine = r + (r * z) * p;
}

// cos r = 1 - r^2/2 + r^4 (C0 + C1 r^2 + ...)
template <class Real>
MIXLOOP_INLINE void cosine_kernel(const Real& z, Real& cosine) {
  const Real z2 = z * z;
  const Real p = (0x1.555555555554cp-5 + z * -0x1.6c16c16c15177p-10) +
                 (z2 * (0x1.a01a019cb159p-16 + z * -0x1.27e4f809c52adp-22) +
                  (z2 * z2) * (0x1.1ee9ebdb4b1c4p-29 + z * -0x1.8fae9be8838d4p-37));
  cosine = (1.0 - 0.5 * z) + z2 * p;
}

// x = k pi/2 + r; the low bits of `shifted` are k's.
template <class Real>
MIXLOOP_INLINE void reduce(const Real& x, Real& r, Real& shifted) {
  shifted = x * kTwoOverPi + kRound;
  const Real k = shifted - kRound;
  r = ((x - k * kHigh) - k * kMiddle) - k * kLow;
}

// Odd quadrants swap sine and cosine; the sine turns in quadrants 2 and 3, the cosine in 1 and 2.
template <class Bits>
MIXLOOP_INLINE void to_quadrant(const Bits& quadrant, Bits& sine, Bits& cosine) {
  const Bits swapped = (sine ^ cosine) & (0 - (quadrant & 1));
  sine ^= swapped ^ ((quadrant & 2) << 62);
  cosine ^= swapped ^ (((quadrant + 1) & 2) << 62);
}

/// Error below 1.6 units in the last place for |x| <= 100, 2.5 up to 1e6 (beside the zeros, where the
/// reduction's second difference rounds); beyond, the C library's.
MIXLOOP_INLINE void sincos(double x, double* sine, double* cosine) {
  if (!(x < kLimit && x > -kLimit)) {
    *sine = sin(x);
    *cosine = cos(x);
    return;
  }
  double r, shifted, s, c;
  reduce(x, r, shifted);
  const double z = r * r;
  sine_kernel(r, z, s);
  cosine_kernel(z, c);
  uint64_t quadrant, u, v;
  memcpy(&quadrant, &shifted, sizeof quadrant);
  memcpy(&u, &s, sizeof u);
  memcpy(&v, &c, sizeof v);
  to_quadrant(quadrant, u, v);
  memcpy(sine, &u, sizeof u);
  memcpy(cosine, &v, sizeof v);
}

#if defined(__GNUC__)

// The same of GCC's and clang's vectors, for angles below kLimit.
template <class Bits, class Real>
MIXLOOP_INLINE void small_sincos(const Real& x, Real& sine, Real& cosine) {
  Real r, shifted, s, c;
  reduce(x, r, shifted);
  const Real z = r * r;
  sine_kernel(r, z, s);
  cosine_kernel(z, c);
  Bits u = (Bits)s, v = (Bits)c;
  to_quadrant((Bits)shifted, u, v);
  sine = (Real)u;
  cosine = (Real)v;
}

typedef double Four __attribute__((vector_size(32)));
typedef int64_t FourBits __attribute__((vector_size(32)));

[[maybe_unused, gnu::noinline, gnu::cold]] static void one_by_one(const Four* x, Four* sine, Four* cosine) {
  for (int i = 0; i < 4; ++i) {
    double s, c;
    sincos((*x)[i], &s, &c);
    (*sine)[i] = s;
    (*cosine)[i] = c;
  }
}

/// The same of up to four angles together.
template <int kCount>
MIXLOOP_INLINE void sincos_of(const double (&x)[kCount], double (&sine)[kCount], double (&cosine)[kCount]) {
  static_assert(kCount <= 4, "four lanes");
  const Four a = {x[0], x[kCount > 1 ? 1 : 0], x[kCount > 2 ? 2 : 0], x[kCount > 3 ? 3 : 0]};
  Four s, c;
  small_sincos<FourBits>(a, s, c);
  double sum = 0.0;
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) sum += fabs(x[i]);
  if (__builtin_expect(!(sum < kLimit), 0)) {
    Four exact_s, exact_c;
    const Four angles = a;  // only this copy's address is taken
    one_by_one(&angles, &exact_s, &exact_c);
    s = exact_s, c = exact_c;
  }
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) sine[i] = s[i], cosine[i] = c[i];
}

#else

template <int kCount>
inline void sincos_of(const double (&x)[kCount], double (&sine)[kCount], double (&cosine)[kCount]) {
  for (int i = 0; i < kCount; ++i) sincos(x[i], sine + i, cosine + i);
}

#endif

}  // namespace mixloop_sincos
