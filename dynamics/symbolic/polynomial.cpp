// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/polynomial.hpp"

#include <algorithm>

namespace mixloop {

void Polynomial::add(const Exponents& exponents, const Expression& coefficient) {
  Expression& mine = terms[exponents];
  mine += coefficient;
  if (mine.is_number() && mine.number() == 0.0) terms.erase(exponents);
}

Polynomial Polynomial::derivative(std::size_t variable) const {
  Polynomial result;
  for (const auto& [exponents, coefficient] : terms) {
    if (exponents[variable] == 0) continue;
    Exponents lower = exponents;
    --lower[variable];
    result.add(lower, coefficient * Expression(static_cast<double>(exponents[variable])));
  }
  return result;
}

namespace {

// The variable that most terms have; the first of several.
std::size_t most_common(const Polynomial& polynomial, std::size_t variables) {
  std::size_t best = 0, most = 0;
  for (std::size_t v = 0; v < variables; ++v) {
    const auto count =
        static_cast<std::size_t>(std::count_if(polynomial.terms.begin(), polynomial.terms.end(),
                                               [&](const auto& term) { return term.first[v] > 0; }));
    if (count > most) best = v, most = count;
  }
  return best;
}

}  // namespace

Expression horner(const Polynomial& polynomial, const std::vector<Expression>& variables) {
  if (polynomial.terms.empty()) return 0.0;
  const auto& [exponents, coefficient] = *polynomial.terms.begin();
  const bool is_constant = std::all_of(exponents.begin(), exponents.end(), [](int e) { return e == 0; });
  if (polynomial.terms.size() == 1 && is_constant) return coefficient;
  const std::size_t v = most_common(polynomial, variables.size());
  Polynomial with, without;
  for (const auto& [exps, coef] : polynomial.terms) {
    if (exps[v] == 0) {
      without.terms[exps] = coef;
      continue;
    }
    Polynomial::Exponents lower = exps;
    --lower[v];
    with.terms[lower] = coef;
  }
  return variables[v] * horner(with, variables) + horner(without, variables);
}

}  // namespace mixloop
