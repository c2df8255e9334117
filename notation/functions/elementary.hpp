// SPDX-License-Identifier: MIT
// exp, log and atan2: the same bits on every machine with IEEE doubles (-ffp-contract=off). Static: an inline
// function's table would keep the shared objects of programs from being unloaded.
// This text also goes into every emitted program, so it stands alone: C++17 and <math.h>.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "notation/functions/fused.hpp"

namespace mixloop_functions {

constexpr double kLogTwo = 0x1.62e42fefa39efp-1;
constexpr double kLogTwoRest = 0x1.abc9e3b39803fp-56;

/// 2^k, -1022 <= k <= 1023.
MIXLOOP_INLINE double power_of_two(int k) {
  const uint64_t bits = (uint64_t)(k + 1023) << 52;
  double result;
  memcpy(&result, &bits, sizeof result);
  return result;
}

/// Error below 0.9 units in the last place, of results below 2^-1021 half a unit more.
[[maybe_unused]] MIXLOOP_FUNCTION static double exp(double x) {
  if (!(x < 710.0)) return x - x == 0 ? HUGE_VAL : x;
  if (x < -746.0) return 0.0;
  // x = k log 2 + r, |r| <= log(2) / 2.
  constexpr double kToWhole = 0x1.8p+52;
  const double k = fma(x, 0x1.71547652b82fep+0, kToWhole) - kToWhole;
  const double near = fnma(k, kLogTwo, x);
  const double r = fnma(k, kLogTwoRest, near), rest = (near - r) - k * kLogTwoRest;
  // Taylor's series; what comes behind r^13 / 13! is below 2^-57.
  const double s = r * r, s2 = s * s;
  const double a = fma(r, 0x1.5555555555555p-3, 0.5);
  const double b = fma(r, 0x1.1111111111111p-7, 0x1.5555555555555p-5);
  const double c = fma(r, 0x1.a01a01a01a01ap-13, 0x1.6c16c16c16c17p-10);
  const double d = fma(r, 0x1.71de3a556c734p-19, 0x1.a01a01a01a01ap-16);
  const double e = fma(r, 0x1.ae64567f544e4p-26, 0x1.27e4fb7789f5cp-22);
  const double f = fma(r, 0x1.6124613a86d09p-33, 0x1.1eed8eff8d898p-29);
  const double p = fma(s2, fma(s2, fma(s, f, e), fma(s, d, c)), fma(s, b, a));
  const double result = 1.0 + (r + fma(s, p, rest));
  const int half = (int)k / 2;
  return result * power_of_two(half) * power_of_two((int)k - half);
}

/// Error below 0.7 units in the last place.
[[maybe_unused]] MIXLOOP_FUNCTION static double log(double x) {
  if (!(x > 0)) return x == 0 ? -HUGE_VAL : (x - x) / 0.0;
  if (!(x < HUGE_VAL)) return x;
  int k = -1023;
  if (x < 0x1p-1022) x *= 0x1p+54, k -= 54;
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  // x = 2^k (1 + f), between the square roots of 1/2 and of 2.
  bits += 0x95f619980c433;
  k += (int)(bits >> 52);
  bits = (bits & 0xfffffffffffff) - 0x95f619980c433 + ((uint64_t)1023 << 52);
  double m;
  memcpy(&m, &bits, sizeof m);
  const double f = m - 1.0, half = 0.5 * f * f, low = f - half, s = f / (2.0 + f), z = s * s, z2 = z * z;
  // log(1 + f) = f - f^2/2 + s (f^2/2 + R), R = L1 s^2 + L2 s^4 + ..., FreeBSD's coefficients.
  const double first = fma(z, 0x1.999999997fa04p-2, 0x1.5555555555593p-1);
  const double second = fma(z, 0x1.c71c51d8e78afp-3, 0x1.2492494229359p-2);
  const double third = fma(z, 0x1.39a09d078c69fp-3, 0x1.7466496cb03dep-3);
  const double R = z * fma((z2 * z2), fma(z2, 0x1.2f112df3e5244p-3, third), fma(z2, second, first));
  const double rest = fma(s, half + R, k * kLogTwoRest);
  const double high = fma((double)k, kLogTwo, low);
  // What the two sums rounded off.
  const double lost = (fma((double)k, kLogTwo, -high) + low) + ((f - low) - half);
  return high + (rest + lost);
}

/// Error below 1 unit in the last place.
[[maybe_unused]] MIXLOOP_FUNCTION static double atan2(double y, double x) {
  // atan(i / 8), and what a double leaves of it.
  static const double kAngle[9][2] = {{0x0p+0, 0x0p+0},
                                      {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                      {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                      {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                      {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                      {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                      {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                      {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                      {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  constexpr double kQuarter = 0x1.921fb54442d18p+0, kQuarterRest = 0x1.1a62633145c07p-54;
  if (x != x || y != y) return x + y;
  const bool steep = fabs(y) > fabs(x);
  double n = steep ? fabs(x) : fabs(y), d = steep ? fabs(y) : fabs(x);
  if (d > 0x1.fffffffffffffp+1023) n = n == d, d = 1;
  if (d == 0) d = 1;
  if (d > 0x1p+1000) n *= 0x1p-100, d *= 0x1p-100;
  if (d < 0x1p-800) n *= 0x1p+200, d *= 0x1p+200;
  // atan(n / d) = atan(i / 8) + atan(u), |u| <= 1/16.
  const double ratio = n / d;
  const int i = (int)fma(8.0, ratio, 0.5);
  const double c = 0.125 * i;
  const double top = fnma(c, d, n), bottom = fma(c, n, d);
  const double u = top / bottom, u_rest = fnma(u, bottom, top) / bottom;
  const double z = u * u, z2 = z * z;
  const double p =
      fma((z2 * z2), fma(z2, -0x1.1111111111111p-4, fma(z, 0x1.3b13b13b13b14p-4, -0x1.745d1745d1746p-4)),
          fma(z2, fma(z, 0x1.c71c71c71c71cp-4, -0x1.2492492492492p-3),
              fma(z, 0x1.999999999999ap-3, -0x1.5555555555555p-2)));
  double high = kAngle[i][0] + u;
  double rest = (u - (high - kAngle[i][0])) + (kAngle[i][1] + fma(u * z, p, u_rest));
  const auto turn_back = [&](double from, double from_rest) {
    const double turned = from - high;
    rest = ((from - turned) - high) + (from_rest - rest);
    high = turned;
  };
  if (steep) turn_back(kQuarter, kQuarterRest);
  if (signbit(x)) turn_back(2 * kQuarter, 2 * kQuarterRest);
  return copysign(high + rest, y);
}

}  // namespace mixloop_functions
