// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

namespace mixloop {

/// The physical dimension of a value: twice the powers of metre, kilogram and second (twice, so that
/// a square root stays whole). Angles are pure numbers, as in SI.
///
/// A bare number such as `0.3` is `open`: it counts as a pure number in products and takes the
/// dimension of its partner in sums, so that a file may be written in plain SI numbers throughout.
struct Dimension {
  int length2 = 0;
  int mass2 = 0;
  int time2 = 0;
  bool open = false;

  bool same_powers(const Dimension& other) const {
    return length2 == other.length2 && mass2 == other.mass2 && time2 == other.time2;
  }
  bool pure() const { return length2 == 0 && mass2 == 0 && time2 == 0; }
};

inline constexpr Dimension kOpen{0, 0, 0, true};
inline constexpr Dimension kPure{};
inline constexpr Dimension kLength{2, 0, 0, false};
inline constexpr Dimension kMass{0, 2, 0, false};
inline constexpr Dimension kTime{0, 0, 2, false};
inline constexpr Dimension kFrequency{0, 0, -2, false};
inline constexpr Dimension kInertia{4, 2, 0, false};
inline constexpr Dimension kAcceleration{2, 0, -4, false};
inline constexpr Dimension kForce{2, 2, -4, false};
inline constexpr Dimension kMoment{4, 2, -4, false};

Dimension operator*(const Dimension& a, const Dimension& b);
Dimension operator/(const Dimension& a, const Dimension& b);
Dimension power(const Dimension& a, int exponent);

/// Of a sum: the dimension both share, or nothing when they differ.
std::optional<Dimension> sum_dimension(const Dimension& a, const Dimension& b);

/// Whether a value of dimension `found` may stand where `wanted` is expected.
bool fits(const Dimension& found, const Dimension& wanted);

/// In words where there are some ("a length"), else in units ("m^2 kg").
std::string to_string(const Dimension& dimension);

}  // namespace mixloop
