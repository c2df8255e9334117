// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/symbolic/double_double.hpp"

namespace mixloop {

constexpr int kMostBaseAngles = 10;  ///< base angles of a harmonic space
constexpr int kMostPowers = 20;      ///< displacements and parameters

/// Which term of a sum: exp(i sum_g angle[g] theta_g) * prod_v x_v^power[v].
struct HarmonicKey {
  std::array<std::int16_t, kMostBaseAngles> angle{};
  std::array<std::int16_t, kMostPowers> power{};

  auto operator<=>(const HarmonicKey&) const = default;
  HarmonicKey operator+(const HarmonicKey& other) const;
};

/// The base angles and the powers' variables that harmonic sums of one scene are made of.
struct HarmonicSpace {
  int n = 0;                                      ///< independent coordinates; powers 0 to n-1 are theirs
  std::vector<std::vector<DoubleDouble>> angles;  ///< d theta_g / d psi_k
};

/// A trigonometric polynomial in a few base angles, and a polynomial in displacements and parameters: a
/// finite sum of complex coefficients times HarmonicKeys. Products of angles' sines and cosines become sums
/// of harmonics, so c^2 + s^2 = 1, absent angles and parallel axes take no rules of their own: what
/// cancels isn't there.
class HarmonicSum {
 public:
  using Complex = std::complex<DoubleDouble>;
  struct Term {
    Complex value;
    DoubleDouble scale = 0;  ///< what went into it: a value far below it is round-off
  };

  HarmonicSum() = default;
  explicit HarmonicSum(DoubleDouble value);
  static HarmonicSum power(int variable);
  /// cos(angle . theta + phase), sin(angle . theta + phase).
  static HarmonicSum cosine(const std::array<std::int16_t, kMostBaseAngles>& angle, DoubleDouble phase);
  static HarmonicSum sine(const std::array<std::int16_t, kMostBaseAngles>& angle, DoubleDouble phase);

  bool is_zero() const { return terms_.empty(); }
  std::size_t size() const { return terms_.size(); }
  const std::map<HarmonicKey, Term>& terms() const { return terms_; }

  HarmonicSum& operator+=(const HarmonicSum& other) { return add(other, 1); }
  HarmonicSum& operator-=(const HarmonicSum& other) { return add(other, -1); }
  HarmonicSum& operator*=(DoubleDouble factor);
  /// this += a * b
  void add_product(const HarmonicSum& a, const HarmonicSum& b);
  /// Drops what is round-off of terms that cancelled.
  void clean();

  HarmonicSum derivative(const HarmonicSpace& space, int k) const;

 private:
  HarmonicSum& add(const HarmonicSum& other, DoubleDouble factor);

  std::map<HarmonicKey, Term> terms_;
};

/// Whether a part of a coefficient is but round-off beside the scale of what went into it.
inline bool is_round_off(DoubleDouble part, DoubleDouble scale) {
  return (part < 0 ? -part : part) <= 3e-15 * scale;
}

}  // namespace mixloop
