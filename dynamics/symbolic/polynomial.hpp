// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/symbolic/expression.hpp"

namespace mixloop {

/// A polynomial in some expressions, with expressions (mostly numbers) for coefficients.
struct Polynomial {
  using Exponents = std::vector<std::uint8_t>;

  std::map<Exponents, Expression> terms;

  void add(const Exponents& exponents, const Expression& coefficient);
  Polynomial derivative(std::size_t variable) const;
};

/// The polynomial's value by a multivariate Horner scheme: the variable that most terms have goes out first.
Expression horner(const Polynomial& polynomial, const std::vector<Expression>& variables);

}  // namespace mixloop
