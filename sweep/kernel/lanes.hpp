// SPDX-License-Identifier: MIT
// Numbers of one run, or of one a lane: choices without branches, and the arrays that they lie in. This text
// also goes into every kernel.
#pragma once

#include <math.h>

#include "notation/functions/fused.hpp"

namespace mixloop_loop {

#if defined(MIXLOOP_VECTORS)
template <class Real, class Mask>
MIXLOOP_INLINE Real chosen(const Mask& mask, const Real& yes, const Real& no) {
  return mask ? yes : no;
}
#else
template <class Real>
MIXLOOP_INLINE Real chosen(bool mask, const Real& yes, const Real& no) {
  return mask ? yes : no;
}
#endif

template <class Real>
struct Memory {
  static constexpr int kLanes = sizeof(Real) / sizeof(double);
  /// Lanes past the last run repeat it.
  MIXLOOP_INLINE static Real load(const double* from, long long i, int runs, int first) {
    Real x = Real();
    for (int lane = 0; lane < kLanes; ++lane) put(x, lane, from[i * runs + at(first, lane, runs)]);
    return x;
  }
  MIXLOOP_INLINE static void store(double* to, long long i, int runs, int first, const Real& x) {
    for (int lane = 0; lane < kLanes && first + lane < runs; ++lane)
      to[i * runs + first + lane] = get(x, lane);
  }
  MIXLOOP_INLINE static int at(int first, int lane, int runs) {
    return first + lane < runs ? first + lane : runs - 1;
  }
#if defined(MIXLOOP_VECTORS)
  MIXLOOP_INLINE static double get(const Real& x, int lane) {
    if constexpr (kLanes == 1)
      return (void)lane, x;
    else
      return x[lane];
  }
  MIXLOOP_INLINE static void put(Real& x, int lane, double value) {
    if constexpr (kLanes == 1)
      (void)lane, x = value;
    else
      x[lane] = value;
  }
#else
  MIXLOOP_INLINE static double get(const Real& x, int) { return x; }
  MIXLOOP_INLINE static void put(Real& x, int, double value) { x = value; }
#endif
};

template <class Real>
MIXLOOP_INLINE Real magnitude(const Real& x) {
  return chosen<Real>(x < 0.0, (Real)-x, (Real)(x + 0.0));  // 0 of -0
}

template <class Real>
MIXLOOP_INLINE Real within(const Real& x, const Real& limit) {
  const Real most = -limit;
  return chosen<Real>(x < most, most, chosen<Real>(limit < x, limit, x));
}

/// What is not a number is below nothing.
template <class Real>
MIXLOOP_INLINE void raise(Real& most, const Real& value) {
  most = chosen<Real>(value <= most, most, value);
}

/// Of each lane alone: of a function that has no vectors.
template <class Real, class Function>
MIXLOOP_INLINE Real each_lane(const Real& x, const Function& of) {
  Real result = x;
  for (int lane = 0; lane < Memory<Real>::kLanes; ++lane)
    Memory<Real>::put(result, lane, of(Memory<Real>::get(x, lane)));
  return result;
}

template <class Real>
MIXLOOP_INLINE bool any_above(const Real& x, double bound) {
  for (int lane = 0; lane < Memory<Real>::kLanes; ++lane)
    if (Memory<Real>::get(x, lane) > bound) return true;
  return false;
}

}  // namespace mixloop_loop
