// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/harmonic_sum.hpp"

#include <algorithm>
#include <cmath>

#include "notation/long_work.hpp"

namespace mixloop {

HarmonicKey HarmonicKey::operator+(const HarmonicKey& other) const {
  HarmonicKey sum = *this;
  for (std::size_t i = 0; i < angle.size(); ++i)
    sum.angle[i] = static_cast<std::int16_t>(angle[i] + other.angle[i]);
  for (std::size_t i = 0; i < power.size(); ++i)
    sum.power[i] = static_cast<std::int16_t>(power[i] + other.power[i]);
  return sum;
}

HarmonicSum::HarmonicSum(DoubleDouble value) {
  if (value != 0) terms_[{}] = {value, abs(value)};
}

HarmonicSum HarmonicSum::power(int variable) {
  HarmonicSum sum;
  HarmonicKey key;
  key.power[static_cast<std::size_t>(variable)] = 1;
  sum.terms_[key] = {Complex(1), 1};
  return sum;
}

namespace {

HarmonicKey key_of(const std::array<std::int16_t, kMostBaseAngles>& angle, int sign) {
  HarmonicKey key;
  std::transform(angle.begin(), angle.end(), key.angle.begin(),
                 [&](int a) { return static_cast<std::int16_t>(sign * a); });
  return key;
}

}  // namespace

// cos x = (e^ix + e^-ix) / 2
HarmonicSum HarmonicSum::cosine(const std::array<std::int16_t, kMostBaseAngles>& angle, DoubleDouble phase) {
  const Complex turn = std::polar(DoubleDouble(0.5), phase);
  HarmonicSum sum;
  for (auto [key, value] : {std::pair{key_of(angle, 1), turn}, {key_of(angle, -1), std::conj(turn)}}) {
    sum.terms_[key].value += value;
    sum.terms_[key].scale += 0.5;
  }
  return sum;
}

HarmonicSum HarmonicSum::sine(const std::array<std::int16_t, kMostBaseAngles>& angle, DoubleDouble phase) {
  // sin x = (e^ix - e^-ix) / 2i
  const Complex turn = std::polar(DoubleDouble(0.5), phase) * Complex(0, -1);
  HarmonicSum sum;
  for (auto [key, value] : {std::pair{key_of(angle, 1), turn}, {key_of(angle, -1), std::conj(turn)}}) {
    sum.terms_[key].value += value;
    sum.terms_[key].scale += 0.5;
  }
  return sum;
}

HarmonicSum& HarmonicSum::add(const HarmonicSum& other, DoubleDouble factor) {
  for (const auto& [key, term] : other.terms_) {
    Term& mine = terms_[key];
    mine.value += factor * term.value;
    mine.scale += term.scale;
  }
  return *this;
}

HarmonicSum& HarmonicSum::operator*=(DoubleDouble factor) {
  for (auto& [key, term] : terms_) {
    term.value *= factor;
    term.scale *= abs(factor);
  }
  return *this;
}

void HarmonicSum::add_product(const HarmonicSum& a, const HarmonicSum& b) {
  for (const auto& [ka, ta] : a.terms_) {
    work_goes_on();
    for (const auto& [kb, tb] : b.terms_) {
      Term& mine = terms_[ka + kb];
      mine.value += ta.value * tb.value;
      mine.scale += ta.scale * tb.scale;
    }
  }
}

void HarmonicSum::clean() {
  for (auto& [key, term] : terms_) {
    if (is_round_off(term.value.real(), term.scale)) term.value.real(0);
    if (is_round_off(term.value.imag(), term.scale)) term.value.imag(0);
  }
  std::erase_if(terms_, [](const auto& entry) { return entry.second.value == Complex(0); });
}

HarmonicSum HarmonicSum::derivative(const HarmonicSpace& space, int k) const {
  HarmonicSum result;
  const auto at = static_cast<std::size_t>(k);
  for (const auto& [key, term] : terms_) {
    DoubleDouble rate = 0;
    for (std::size_t g = 0; g < space.angles.size(); ++g) rate += key.angle[g] * space.angles[g][at];
    if (rate != 0) {
      Term& mine = result.terms_[key];
      mine.value += term.value * Complex(0, rate);
      mine.scale += term.scale * abs(rate);
    }
    if (key.power[at] > 0) {
      HarmonicKey lower = key;
      --lower.power[at];
      Term& mine = result.terms_[lower];
      mine.value += term.value * DoubleDouble(key.power[at]);
      mine.scale += term.scale * DoubleDouble(key.power[at]);
    }
  }
  return result;
}

}  // namespace mixloop
