// SPDX-License-Identifier: MIT
// The functions of emitted code on 4 and 8 lanes (GCC's and clang's vectors): lane by lane the same bits
// as the scalar ones.

namespace mixloop_lanes {

template <int kLanes>
struct Vectors;
template <>
struct Vectors<4> {
  typedef double Real __attribute__((vector_size(32)));
  typedef double Loose __attribute__((vector_size(32), aligned(8), may_alias));  // as a caller's doubles lie
  typedef int64_t Bits __attribute__((vector_size(32)));
};
template <>
struct Vectors<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef double Loose __attribute__((vector_size(64), aligned(8), may_alias));
  typedef int64_t Bits __attribute__((vector_size(64)));
};
using Lanes4 = Vectors<4>::Real;
using Lanes8 = Vectors<8>::Real;

template <int kLanes, class Function>
MIXLOOP_INLINE typename Vectors<kLanes>::Real lane_by_lane(typename Vectors<kLanes>::Real x,
                                                           Function function) {
  for (int i = 0; i < kLanes; ++i) x[i] = function(x[i]);
  return x;
}

template <int kLanes>
__attribute__((noinline, cold)) void one_by_one(const typename Vectors<kLanes>::Real* x,
                                                typename Vectors<kLanes>::Real* sine,
                                                typename Vectors<kLanes>::Real* cosine) {
  for (int lane = 0; lane < kLanes; ++lane) {
    double s, c;
    mixloop_functions::sincos((*x)[lane], &s, &c);
    (*sine)[lane] = s;
    (*cosine)[lane] = c;
  }
}

template <int kLanes, int kCount>
MIXLOOP_INLINE void sincos_of(const typename Vectors<kLanes>::Real (&x)[kCount],
                              typename Vectors<kLanes>::Real (&sine)[kCount],
                              typename Vectors<kLanes>::Real (&cosine)[kCount]) {
  using Real = typename Vectors<kLanes>::Real;
  using Bits = typename Vectors<kLanes>::Bits;
  Bits any_far = {};
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) {
    mixloop_functions::small_sincos<Bits>(x[i], sine[i], cosine[i]);
    Bits far;
    mixloop_functions::mark_far(x[i], far);
    any_far |= far;
  }
  if (__builtin_expect(!mixloop_functions::any_negative(any_far), 1)) return;
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) {
    const Real angle = x[i];  // only these copies' addresses are taken
    Real s, c;
    one_by_one<kLanes>(&angle, &s, &c);
    sine[i] = s, cosine[i] = c;
  }
}

}  // namespace mixloop_lanes

namespace mixloop_functions {
template <int kCount>
MIXLOOP_INLINE void sincos_of(const mixloop_lanes::Lanes4 (&x)[kCount], mixloop_lanes::Lanes4 (&sine)[kCount],
                              mixloop_lanes::Lanes4 (&cosine)[kCount]) {
  mixloop_lanes::sincos_of<4, kCount>(x, sine, cosine);
}
template <int kCount>
MIXLOOP_INLINE void sincos_of(const mixloop_lanes::Lanes8 (&x)[kCount], mixloop_lanes::Lanes8 (&sine)[kCount],
                              mixloop_lanes::Lanes8 (&cosine)[kCount]) {
  mixloop_lanes::sincos_of<8, kCount>(x, sine, cosine);
}

/// Of 4 or 8 lanes.
template <class Lanes, int kTerms, int kCount>
MIXLOOP_INLINE void sincos_of_affine(const Lanes (&q)[kTerms], const double (&factor)[kTerms][kCount],
                                     const double (&constant)[kCount], Lanes (&sine)[kCount],
                                     Lanes (&cosine)[kCount]) {
  Lanes x[kCount];
#pragma GCC unroll 4
  for (int i = 0; i < kCount; ++i) {
    x[i] = lift<Lanes>(constant[i]);
#pragma GCC unroll 4
    for (int k = 0; k < kTerms; ++k)
      if (factor[k][i] != 0) x[i] = fma(q[k], lift<Lanes>(factor[k][i]), x[i]);
  }
  sincos_of(x, sine, cosine);
}

#if defined(__x86_64__) && defined(__AVX512F__) && !defined(__clang__)
MIXLOOP_INLINE mixloop_lanes::Lanes8 root(mixloop_lanes::Lanes8 x) {
  return __builtin_ia32_sqrtpd512_mask(x, x, -1, 4);
}
#else
MIXLOOP_INLINE mixloop_lanes::Lanes8 root(mixloop_lanes::Lanes8 x) {
  return mixloop_lanes::lane_by_lane<8>(x, [](double y) { return sqrt(y); });
}
#endif
#if defined(__AVX__) && !defined(__clang__)
MIXLOOP_INLINE mixloop_lanes::Lanes4 root(mixloop_lanes::Lanes4 x) { return __builtin_ia32_sqrtpd256(x); }
#else
MIXLOOP_INLINE mixloop_lanes::Lanes4 root(mixloop_lanes::Lanes4 x) {
  return mixloop_lanes::lane_by_lane<4>(x, [](double y) { return sqrt(y); });
}
#endif

#define MIXLOOP_LANE_BY_LANE(name)                                              \
  MIXLOOP_INLINE mixloop_lanes::Lanes4 name(mixloop_lanes::Lanes4 x) {          \
    return mixloop_lanes::lane_by_lane<4>(x, [](double y) { return name(y); }); \
  }                                                                             \
  MIXLOOP_INLINE mixloop_lanes::Lanes8 name(mixloop_lanes::Lanes8 x) {          \
    return mixloop_lanes::lane_by_lane<8>(x, [](double y) { return name(y); }); \
  }
MIXLOOP_LANE_BY_LANE(exp)
MIXLOOP_LANE_BY_LANE(log)
#undef MIXLOOP_LANE_BY_LANE
template <class Lanes>
MIXLOOP_INLINE Lanes atan2(Lanes y, Lanes x) {
  for (unsigned i = 0; i < sizeof(Lanes) / sizeof(double); ++i) y[i] = atan2((double)y[i], (double)x[i]);
  return y;
}
}  // namespace mixloop_functions
