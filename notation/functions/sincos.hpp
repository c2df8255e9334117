// SPDX-License-Identifier: MIT
// Sine and cosine together, branch-free in the common range and vectorisable; the same bits on every
// machine with IEEE doubles, as long as products and sums are not contracted (-ffp-contract=off).
// This text also goes into every emitted program, so it stands alone: C++17 and <math.h>.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "notation/functions/fused.hpp"

namespace mixloop_functions {

// pi/2 in three parts: what k times the first leaves of x is exact for |k| < 2^20, k times the second
// rounds once.
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr double kHigh = 0x1.921fb54442d18p+0;
constexpr double kMiddle = 0x1.1a62633145c07p-54;
constexpr double kLow = -0x1.f1976b7ed8fbcp-110;
constexpr double kLimit = 0x1p+20;
constexpr double kRound = 0x1.8p+52;  // adding it rounds to the nearest whole number, kept in the low bits

// sin r = r + r^3 (S0 + S1 r^2 + ...), |r| <= pi/4, z = r^2; FreeBSD's coefficients, error below 2^-58. In
// Estrin's order, whose chains are short.
template <class Real>
MIXLOOP_INLINE void sine_kernel(const Real& r, const Real& z, Real& sine) {
  const Real z2 = z * z;
  const Real first = fma(z, lift<Real>(0x1.111111110f8a6p-7), lift<Real>(-0x1.5555555555549p-3));
  const Real second = fma(z, lift<Real>(0x1.71de357b1fe7dp-19), lift<Real>(-0x1.a01a019c161d5p-13));
  const Real third = fma(z, lift<Real>(0x1.5d93a5acfd57cp-33), lift<Real>(-0x1.ae5e68a2b9cebp-26));
  const Real p = fma((Real)(z2 * z2), third, fma(z2, second, first));
  sine = fma((Real)(r * z), p, r);
}

// cos r = 1 - r^2/2 + r^4 (C0 + C1 r^2 + ...)
template <class Real>
MIXLOOP_INLINE void cosine_kernel(const Real& z, Real& cosine) {
  const Real z2 = z * z;
  const Real first = fma(z, lift<Real>(-0x1.6c16c16c15177p-10), lift<Real>(0x1.555555555554cp-5));
  const Real second = fma(z, lift<Real>(-0x1.27e4f809c52adp-22), lift<Real>(0x1.a01a019cb159p-16));
  const Real third = fma(z, lift<Real>(-0x1.8fae9be8838d4p-37), lift<Real>(0x1.1ee9ebdb4b1c4p-29));
  const Real p = fma((Real)(z2 * z2), third, fma(z2, second, first));
  cosine = fma(z2, p, fnma(lift<Real>(0.5), z, lift<Real>(1.0)));
}

// x = k pi/2 + r; the low bits of `shifted` are k's. `near` is r but for what a square doesn't feel, and
// known earlier.
template <class Real>
MIXLOOP_INLINE void reduce(const Real& x, Real& near, Real& r, Real& shifted) {
  shifted = fma(x, lift<Real>(kTwoOverPi), lift<Real>(kRound));
  const Real k = shifted - kRound;
  near = fnma(k, lift<Real>(kMiddle), fnma(k, lift<Real>(kHigh), x));
  r = fnma(k, lift<Real>(kLow), near);
}

// Odd quadrants swap sine and cosine; the sine turns in quadrants 2 and 3, the cosine in 1 and 2.
template <class Bits>
MIXLOOP_INLINE void to_quadrant(const Bits& quadrant, Bits& sine, Bits& cosine) {
  const Bits odd = 0 - (quadrant & 1), turned = (quadrant & 2) << 62, turned_too = ((quadrant + 1) & 2) << 62;
  const Bits s = (sine & ~odd) | (cosine & odd), c = (cosine & ~odd) | (sine & odd);
  sine = s ^ turned;
  cosine = c ^ turned_too;
}

// Of angles from kLimit on: 2/pi's bits that matter times the angle's (Payne and Hanek), in whole numbers.
// Gives the quadrant; of what is no number nothing.
#if defined(MIXLOOP_VECTORS)
[[maybe_unused, gnu::noinline, gnu::cold]]
#endif
MIXLOOP_FUNCTION static uint64_t
reduce_large(double x, double* r) {
  static const uint32_t kBits[40] = {
      0xA2F9836E, 0x4E441529, 0xFC2757D1, 0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB, 0xDEBBC561,
      0xB7246E3A, 0x424DD2E0, 0x06492EEA, 0x09D1921C, 0xFE1DEB1C, 0xB129A73E, 0xE88235F5, 0x2EBB4484,
      0xE99C7026, 0xB45F7E41, 0x3991D639, 0x835339F4, 0x9C845F8B, 0xBDF9283B, 0x1FF897FF, 0xDE05980F,
      0xEF2F118B, 0x5A0A6D1F, 0x6D367ECF, 0x27CB09B7, 0x4F463F66, 0x9E5FEA2D, 0x7527BAC7, 0xEBE5F17B,
      0x3D0739F7, 0x8A5292EA, 0x6BFB5FB1, 0x1F8D5D08, 0x56033046, 0xFC7B6BAB, 0xF0CFBC20, 0x9AF4361D};
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  const int exponent = (int)(bits >> 52 & 0x7ff) - 1075;  // |x| = m 2^exponent, m of 53 bits
  const uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;
  if (exponent > 971) {
    *r = x - x;
    return 0;
  }
  // 192 bits of 2/pi behind those that give whole turns.
  const int skipped = exponent > 2 ? exponent - 2 : 0;
  uint32_t window[6], product[9] = {0}, fraction[8];
  for (int i = 0; i < 6; ++i) {
    const uint64_t two = (uint64_t)kBits[skipped / 32 + i] << 32 | kBits[skipped / 32 + i + 1];
    window[i] = (uint32_t)(two >> (32 - skipped % 32));
  }
  for (int half = 0; half < 2; ++half) {  // m's lower word first; product[8] is the lowest
    const uint64_t factor = half == 0 ? m & 0xffffffff : m >> 32;
    uint64_t carry = 0;
    for (int i = 5; i >= 0; --i) {
      carry += factor * window[i] + product[i + 3 - half];
      product[i + 3 - half] = (uint32_t)carry;
      carry >>= 32;
    }
    product[2 - half] = (uint32_t)carry;
  }
  // The point stands behind so many of its bits, which start in product[1]: two of them count quadrants.
  const int whole = 64 + exponent - skipped;
  const int first = 32 + whole - 2, word = first / 32, shift = first % 32;
  for (int i = 0; i < 8; ++i) {
    const uint64_t two = (uint64_t)(word + i < 9 ? product[word + i] : 0) << 32 |
                         (word + i + 1 < 9 ? product[word + i + 1] : 0);
    fraction[i] = (uint32_t)(two >> (32 - shift));
  }
  uint64_t quadrant = fraction[0] >> 30;
  for (int i = 0; i < 8; ++i) fraction[i] = fraction[i] << 2 | (i < 7 ? fraction[i + 1] >> 30 : 0);
  // To the nearest quadrant: from -1/2 to 1/2.
  const bool past_half = fraction[0] >> 31 != 0;
  quadrant += past_half;
  double high = 0, low = 0, unit = past_half ? -0x1p-32 : 0x1p-32;
  for (int i = 0; i < 8; ++i, unit *= 0x1p-32) {
    const double part = (past_half ? ~fraction[i] : fraction[i]) * unit;
    const double sum = high + part;
    low += part - (sum - high);
    high = sum;
  }
  const double angle = high * kHigh;
  *r = angle + fma(low, kHigh, fma(high, kMiddle, fma(high, kHigh, -angle)));
  if (x < 0) {
    *r = -*r;
    quadrant = 0 - quadrant;
  }
  return quadrant;
}

/// Error below 1.6 units in the last place, of angles of any size.
MIXLOOP_INLINE void sincos(double x, double* sine, double* cosine) {
  double near, r, shifted, s, c;
  uint64_t quadrant, u, v;
  if (x < kLimit && x > -kLimit) {
    reduce(x, near, r, shifted);
    memcpy(&quadrant, &shifted, sizeof quadrant);
  } else {
    quadrant = reduce_large(x, &r);
    near = r;
  }
  const double z = near * near;
  sine_kernel(r, z, s);
  cosine_kernel(z, c);
  memcpy(&u, &s, sizeof u);
  memcpy(&v, &c, sizeof v);
  to_quadrant(quadrant, u, v);
  memcpy(sine, &u, sizeof u);
  memcpy(cosine, &v, sizeof v);
}

inline double sin(double x) {
  double sine, cosine;
  sincos(x, &sine, &cosine);
  return sine;
}

inline double cos(double x) {
  double sine, cosine;
  sincos(x, &sine, &cosine);
  return cosine;
}

#if defined(MIXLOOP_VECTORS)

// The same of GCC's and clang's vectors, for angles below kLimit.
template <class Bits, class Real>
MIXLOOP_INLINE void small_sincos(const Real& x, Real& sine, Real& cosine) {
  Real near, r, shifted, s, c;
  reduce(x, near, r, shifted);
  const Real z = near * near;
  sine_kernel(r, z, s);
  cosine_kernel(z, c);
  // As to_quadrant.
  const Bits quadrant = (Bits)shifted, sign = Bits() + INT64_MIN, odd = (quadrant << 63) < 0;
  sine = (Real)((Bits)(odd ? c : s) ^ ((quadrant << 62) & sign));
  cosine = (Real)((Bits)(odd ? s : c) ^ (((quadrant + 1) << 62) & sign));
}

// Negative in lanes from kLimit on, or of no number.
template <class Bits, class Real>
MIXLOOP_INLINE void mark_far(const Real& x, Bits& far) {
  constexpr int64_t kMagnitude = INT64_MAX, kNearest = 0x412fffffffffffff;  // the double below kLimit
  far = kNearest - ((Bits)x & kMagnitude);
}

template <class Bits>
MIXLOOP_INLINE bool any_negative(const Bits& lanes) {
#if defined(__x86_64__) && defined(__AVX__)
  typedef double Doubles __attribute__((vector_size(32)));
  if constexpr (sizeof(Bits) == 32) return __builtin_ia32_movmskpd256((Doubles)lanes) != 0;
#endif
#if defined(__x86_64__) && defined(__AVX512DQ__)
  typedef long long Longs __attribute__((vector_size(64)));
  if constexpr (sizeof(Bits) == 64) return __builtin_ia32_cvtq2mask512((Longs)lanes) != 0;
#endif
  int64_t any = 0;
  for (unsigned i = 0; i < sizeof(Bits) / sizeof(int64_t); ++i) any |= lanes[i];
  return any < 0;
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

template <int kCount>
MIXLOOP_INLINE void sincos_of_four(const Four& x, double (&sine)[kCount], double (&cosine)[kCount]) {
  static_assert(kCount <= 4, "four lanes");
  Four s, c;
  small_sincos<FourBits>(x, s, c);
  FourBits far;
  mark_far(x, far);
  if (__builtin_expect(any_negative(far), 0)) {
    Four exact_s, exact_c;
    const Four angles = x;  // only this copy's address is taken
    one_by_one(&angles, &exact_s, &exact_c);
    s = exact_s, c = exact_c;
  }
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) sine[i] = s[i], cosine[i] = c[i];
}

template <int kCount>
MIXLOOP_INLINE Four four_of(const double (&x)[kCount]) {
  return Four{x[0], x[kCount > 1 ? 1 : 0], x[kCount > 2 ? 2 : 0], x[kCount > 3 ? 3 : 0]};
}

/// The same of up to four angles together.
template <int kCount>
MIXLOOP_INLINE void sincos_of(const double (&x)[kCount], double (&sine)[kCount], double (&cosine)[kCount]) {
  sincos_of_four(four_of(x), sine, cosine);
}

/// The same of the angles constant[i] + sum of factor[k][i] q[k], products taken in one after the other.
template <int kTerms, int kCount>
MIXLOOP_INLINE void sincos_of_affine(const double (&q)[kTerms], const double (&factor)[kTerms][kCount],
                                     const double (&constant)[kCount], double (&sine)[kCount],
                                     double (&cosine)[kCount]) {
  Four x = four_of(constant);
#pragma GCC unroll 4
  for (int k = 0; k < kTerms; ++k) x = fma(lift<Four>(q[k]), four_of(factor[k]), x);
  sincos_of_four(x, sine, cosine);
}

#else

template <int kCount>
MIXLOOP_INLINE void sincos_of(const double (&x)[kCount], double (&sine)[kCount], double (&cosine)[kCount]) {
  for (int i = 0; i < kCount; ++i) sincos(x[i], sine + i, cosine + i);
}

template <int kTerms, int kCount>
MIXLOOP_INLINE void sincos_of_affine(const double (&q)[kTerms], const double (&factor)[kTerms][kCount],
                                     const double (&constant)[kCount], double (&sine)[kCount],
                                     double (&cosine)[kCount]) {
  for (int i = 0; i < kCount; ++i) {
    double x = constant[i];
    for (int k = 0; k < kTerms; ++k) x = fma(q[k], factor[k][i], x);
    sincos(x, sine + i, cosine + i);
  }
}

#endif

}  // namespace mixloop_functions
