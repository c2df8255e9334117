// SPDX-License-Identifier: MIT
// a b + c, rounded once, of doubles and of GCC's and clang's vectors: the same bits everywhere. Where the
// processor has no such operation, the C library's function does it, exactly, and slower.
// This text also goes into every emitted program, so it stands alone: C++17 and <math.h>.
#pragma once

#include <math.h>

// Inlined whatever its size: a call would take a good part of the time. A graphics processor's compiler has
// the same functions on either side, and no vectors.
#if defined(__CUDACC__)
#define MIXLOOP_FUNCTION __host__ __device__
#define MIXLOOP_INLINE __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define MIXLOOP_VECTORS
#define MIXLOOP_FUNCTION
#define MIXLOOP_INLINE inline __attribute__((always_inline))
#else
#define MIXLOOP_FUNCTION
#define MIXLOOP_INLINE inline
#endif

namespace mixloop_functions {

/// A number, or a vector of it; of a vector itself.
template <class Real, class Number>
MIXLOOP_INLINE Real lift(Number x) {
  if constexpr (sizeof(Number) == sizeof(Real))
    return x;
  else
    return x - Real();
}

#if defined(MIXLOOP_VECTORS)

MIXLOOP_INLINE double fma(double a, double b, double c) { return __builtin_fma(a, b, c); }

/// By reference, so that vectors meet no calling convention.
template <class Real>
MIXLOOP_INLINE Real fma(const Real& a, const Real& b, const Real& c) {
#if defined(__x86_64__) && defined(__FMA__)
  if constexpr (sizeof(Real) == 32) return (Real)__builtin_ia32_vfmaddpd256(a, b, c);
#endif
#if defined(__x86_64__) && defined(__AVX512F__)
  if constexpr (sizeof(Real) == 64) return (Real)__builtin_ia32_vfmaddpd512_mask(a, b, c, -1, 4);
#endif
  Real result = c;
  for (unsigned i = 0; i < sizeof(Real) / sizeof(double); ++i) result[i] = __builtin_fma(a[i], b[i], c[i]);
  return result;
}

#else

MIXLOOP_INLINE double fma(double a, double b, double c) { return ::fma(a, b, c); }

#endif

/// a b - c
template <class Real>
MIXLOOP_INLINE Real fms(const Real& a, const Real& b, const Real& c) {
  return fma(a, b, (Real)-c);
}

/// c - a b
template <class Real>
MIXLOOP_INLINE Real fnma(const Real& a, const Real& b, const Real& c) {
  return fma((Real)-a, b, c);
}

}  // namespace mixloop_functions
