// SPDX-License-Identifier: MIT
#include "notation/dimension.hpp"

#include <utility>

namespace mixloop {

Dimension operator*(const Dimension& a, const Dimension& b) {
  return {a.length2 + b.length2, a.mass2 + b.mass2, a.time2 + b.time2, a.open && b.open};
}

Dimension operator/(const Dimension& a, const Dimension& b) {
  return {a.length2 - b.length2, a.mass2 - b.mass2, a.time2 - b.time2, a.open && b.open};
}

Dimension power(const Dimension& a, int exponent) {
  return {a.length2 * exponent, a.mass2 * exponent, a.time2 * exponent, a.open};
}

std::optional<Dimension> sum_dimension(const Dimension& a, const Dimension& b) {
  if (a.open) return b;
  if (b.open || a.same_powers(b)) return a;
  return std::nullopt;
}

bool fits(const Dimension& found, const Dimension& wanted) {
  return found.open || wanted.open || found.same_powers(wanted);
}

std::string to_string(const Dimension& dimension) {
  static constexpr std::pair<Dimension, const char*> kWords[] = {{kPure, "a number or an angle"},
                                                                 {kLength, "a length (m)"},
                                                                 {kMass, "a mass (kg)"},
                                                                 {kTime, "a time (s)"},
                                                                 {kFrequency, "a rate (1/s)"},
                                                                 {kInertia, "a moment of inertia (kg m^2)"},
                                                                 {kAcceleration, "an acceleration (m/s^2)"},
                                                                 {{2, 0, -2, false}, "a speed (m/s)"},
                                                                 {kForce, "a force (N)"},
                                                                 {kMoment, "a moment (N m)"}};
  for (const auto& [known, word] : kWords)
    if (known.same_powers(dimension)) return word;
  std::string text;
  const auto add = [&](const char* unit, int twice) {
    if (twice == 0) return;
    if (!text.empty()) text += ' ';
    text += unit;
    if (twice == 2) return;
    text += "^" + (twice % 2 == 0 ? std::to_string(twice / 2) : "(" + std::to_string(twice) + "/2)");
  };
  add("kg", dimension.mass2);
  add("m", dimension.length2);
  add("s", dimension.time2);
  return text;
}

}  // namespace mixloop
