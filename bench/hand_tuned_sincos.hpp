// SPDX-License-Identifier: MIT
// Sine and cosine for vectors of doubles (GCC's and clang's vector extensions), branch-free.
#pragma once

#include <cstdint>

namespace mixloop::hand_tuned {

template <int lanes>
struct LaneTypes {
  using Real [[gnu::vector_size(lanes * 8)]] = double;
  using Bits [[gnu::vector_size(lanes * 8)]] = std::int64_t;
};
template <int lanes>
using Lanes = typename LaneTypes<lanes>::Real;

/// Cody and Waite's reduction by pi/2 in three parts (exact products up to |x| = 1.6e6), then FreeBSD's
/// kernel polynomials on |r| <= pi/4, the cosine's without its compensation. No other path: |x| must stay
/// below 1.6e6. Error below 1.6 units in the last place for |x| <= 100, 2.5 beyond, where the reduction's
/// second difference rounds (bench/hand_tuned_test holds both).
template <int lanes>
inline void lane_sincos(Lanes<lanes> x, Lanes<lanes>* sine, Lanes<lanes>* cosine) {
  using Real = Lanes<lanes>;
  using Bits = typename LaneTypes<lanes>::Bits;
  constexpr double kRound = 0x1.8p+52;  // adding it rounds to the nearest whole number, kept in the low bits
  const Real shifted = x * 0x1.45f306dc9c883p-1 + kRound;
  const Real k = shifted - kRound;
  const Real r = ((x - k * 0x1.921fb544p+0) - k * 0x1.0b4611a6p-34) - k * 0x1.3198a2e037073p-69;
  const Real z = r * r, z2 = z * z;
  // Estrin's order: shorter chains than Horner's.
  const Real s = r + (r * z) * ((-0x1.5555555555549p-3 + z * 0x1.111111110f8a6p-7) +
                                z2 * ((-0x1.a01a019c161d5p-13 + z * 0x1.71de357b1fe7dp-19) +
                                      z2 * (-0x1.ae5e68a2b9cebp-26 + z * 0x1.5d93a5acfd57cp-33)));
  const Real c = (1.0 - 0.5 * z) + z2 * ((0x1.555555555554cp-5 + z * -0x1.6c16c16c15177p-10) +
                                         z2 * ((0x1.a01a019cb159p-16 + z * -0x1.27e4f809c52adp-22) +
                                               z2 * (0x1.1ee9ebdb4b1c4p-29 + z * -0x1.8fae9be8838d4p-37)));
  // Odd quadrants swap sine and cosine; the sine turns in quadrants 2 and 3, the cosine in 1 and 2.
  const Bits quadrant = (Bits)shifted, sign = Bits{} + INT64_MIN;
  const Bits odd = (quadrant << 63) < 0;
  *sine = (Real)((Bits)(odd ? c : s) ^ ((quadrant << 62) & sign));
  *cosine = (Real)((Bits)(odd ? s : c) ^ (((quadrant + 1) << 62) & sign));
}

/// The same for one angle, the same bits: sine's and cosine's polynomials side by side in two lanes.
inline void paired_sincos(double x, double* sine, double* cosine) {
  using Real = Lanes<2>;
  using Bits = LaneTypes<2>::Bits;
  constexpr double kRound = 0x1.8p+52;
  const double shifted = x * 0x1.45f306dc9c883p-1 + kRound;
  const double k = shifted - kRound;
  const double r = ((x - k * 0x1.921fb544p+0) - k * 0x1.0b4611a6p-34) - k * 0x1.3198a2e037073p-69;
  const double square = r * r;
  const Real z = {square, square}, z2 = z * z;
  const Real first = {r, 1.0 - 0.5 * square}, factor = {r, square};
  const Real p = (Real{-0x1.5555555555549p-3, 0x1.555555555554cp-5} +
                  z * Real{0x1.111111110f8a6p-7, -0x1.6c16c16c15177p-10}) +
                 z2 * ((Real{-0x1.a01a019c161d5p-13, 0x1.a01a019cb159p-16} +
                        z * Real{0x1.71de357b1fe7dp-19, -0x1.27e4f809c52adp-22}) +
                       z2 * (Real{-0x1.ae5e68a2b9cebp-26, 0x1.1ee9ebdb4b1c4p-29} +
                             z * Real{0x1.5d93a5acfd57cp-33, -0x1.8fae9be8838d4p-37}));
  const Real both = first + (factor * z) * p;
  const Real swapped = {both[1], both[0]};
  const Bits quadrant = (Bits)Real{shifted, shifted};
  const Bits odd = (quadrant << 63) < 0;
  const Bits sign = ((quadrant + Bits{0, 1}) << 62) & (Bits{} + INT64_MIN);
  const Real turned = (Real)((Bits)(odd ? swapped : both) ^ sign);
  *sine = turned[0];
  *cosine = turned[1];
}

}  // namespace mixloop::hand_tuned
