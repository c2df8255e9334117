// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/double_double.hpp"

namespace mixloop {
namespace {

// Taylor's series of an angle below pi/4, from r or 1 on.
DoubleDouble taylor(const DoubleDouble& square, int first) {
  DoubleDouble term = 1.0, sum = 1.0;
  for (int k = first; k < first + 26; k += 2) {
    term *= square / DoubleDouble(-static_cast<double>(k) * (k + 1));
    sum += term;
  }
  return sum;
}

// x = quadrant pi/2 + r
struct Reduced {
  DoubleDouble r;
  int quadrant;
};

Reduced reduced(const DoubleDouble& x) {
  constexpr double kRest = -0x1.f1976b7ed8fbcp-110;  // of pi/2
  const double k = round(x / (kPi * 0.5)).high();
  const DoubleDouble r =
      ((x - DoubleDouble(kPi.high() / 2) * k) - DoubleDouble(kPi.low() / 2) * k) - kRest * k;
  return {r, static_cast<int>(k - 4 * std::floor(k / 4))};
}

DoubleDouble sine_from(const Reduced& angle, int quarters) {
  const int quadrant = (angle.quadrant + quarters) % 4;
  const DoubleDouble square = angle.r * angle.r;
  const DoubleDouble value = quadrant % 2 == 0 ? angle.r * taylor(square, 2) : taylor(square, 1);
  return quadrant < 2 ? value : -value;
}

}  // namespace

DoubleDouble floor(const DoubleDouble& x) {
  const double high = std::floor(x.high());
  if (high != x.high()) return high;
  return DoubleDouble(high) + DoubleDouble(std::floor(x.low()));
}

DoubleDouble sqrt(const DoubleDouble& x) {
  const double root = std::sqrt(x.high());
  if (!(root > 0)) return root;
  return DoubleDouble(root) + (x - DoubleDouble(root) * root) / (2 * root);
}

DoubleDouble sin(const DoubleDouble& x) { return sine_from(reduced(x), 0); }
DoubleDouble cos(const DoubleDouble& x) { return sine_from(reduced(x), 1); }

// A step of Newton's from the double's.
DoubleDouble atan2(const DoubleDouble& y, const DoubleDouble& x) {
  const DoubleDouble near = mixloop_functions::atan2(y.high(), x.high());
  const DoubleDouble size = x * x + y * y;
  if (size == 0.0) return near;
  return near + (y * cos(near) - x * sin(near)) / sqrt(size);
}

}  // namespace mixloop
