// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "notation/dimension.hpp"
#include "notation/errors.hpp"
#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {

struct Node;

/// An arithmetic expression as a person wrote it, e.g. `((1 + 1/r2)/r1 * psi1 - psi2/r2) / r3`.
/// Nodes stand in postorder, the root last; what is constant is folded; values are in SI. At most 4096
/// nodes and 256 levels, so that an evaluation may recurse.
struct Formula {
  enum class Operator {
    constant,
    symbol,
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    atan2,
    sqrt,
    exp,
    log
  };
  struct Node {
    Operator op = Operator::constant;
    int left = -1;     ///< index of the (first) operand
    int right = -1;    ///< index of the second operand
    double value = 0;  ///< constant
    int symbol = -1;   ///< symbol: the number that the scope gave it
    int exponent = 0;  ///< power: a whole number
  };

  std::vector<Node> nodes;
  Dimension dimension;
  Place place;
  int height = 1;  ///< levels of the tree

  bool is_constant() const { return nodes.size() == 1 && nodes[0].op == Operator::constant; }
  bool is_zero() const { return is_constant() && nodes[0].value == 0; }
  /// Only where is_constant().
  double constant() const { return nodes[0].value; }
};

Formula constant_formula(double value, const Dimension& dimension = kPure, const Place& place = {});

/// The names that a formula may use, each a numbered symbol or a formula to insert.
class Scope {
 public:
  void define_symbol(const std::string& name, int symbol, const Dimension& dimension, const Place& place);
  void define_formula(const std::string& name, Formula formula, const Place& place);

  struct Meaning {
    int symbol = -1;  ///< or -1: then the formula
    Formula formula;
    Place place;
  };
  const Meaning* find(std::string_view name) const;
  std::vector<std::string> names() const;

 private:
  void define(const std::string& name, Meaning meaning);
  std::map<std::string, Meaning, std::less<>> meanings_;
};

/// Throws InputError("invalid_name") unless `name` is a letter followed by letters, digits and _, and
/// neither a unit, a function, nor pi.
void check_name(const std::string& name, const Place& place);

/// Reads a formula from a document's scalar: + - * / ^ with whole powers, parentheses, sin cos tan asin acos
/// atan atan2 sqrt exp log, pi, numbers with units (`30 cm`, `9.81 m/s^2`, `0.02 kg m^2`) and the scope's
/// names. Throws InputError: "wrong_kind" (saying that `what` was expected) for no scalar, and with the line
/// and column of the offence "invalid_formula", "undefined_symbol", "unknown_unit", "wrong_dimension",
/// "not_finite" (also for a division by a constant zero), "too_large", "too_deep".
Formula parse_formula(const Node& scalar, const std::string& what, const Scope& scope);

/// Throws InputError("wrong_dimension") unless the formula may stand for `what` of dimension `wanted`.
void require_dimension(const Formula& formula, const Dimension& wanted, const std::string& what);

/// The names in `text` that look like symbols: how definitions are put in order before they are read.
std::vector<std::string> names_in(std::string_view text);

/// 0: independent of the chosen symbols, as one without nodes is; 1: affine in them; 2: neither.
int degree(const Formula& formula, const std::function<bool(int symbol)>& chosen);
inline bool depends_on(const Formula& formula, const std::function<bool(int symbol)>& chosen) {
  return degree(formula, chosen) > 0;
}

namespace detail {

template <class T>
T whole_power(const T& base, int exponent) {
  if (exponent < 0) return T(1) / whole_power(base, -exponent);
  if (exponent == 0) return T(1);
  const T half = whole_power(base, exponent / 2);
  return exponent % 2 == 0 ? half * half : half * half * base;
}

template <class T, class Lookup>
T evaluate_node(const Formula& formula, int index, const Lookup& symbol) {
  using mixloop_functions::atan2, mixloop_functions::cos, mixloop_functions::exp, mixloop_functions::log,
      mixloop_functions::sin, std::sqrt;
  using Op = Formula::Operator;
  const Formula::Node& node = formula.nodes[static_cast<std::size_t>(index)];
  const auto left = [&] { return evaluate_node<T>(formula, node.left, symbol); };
  const auto right = [&] { return evaluate_node<T>(formula, node.right, symbol); };
  switch (node.op) {
    case Op::constant:
      return T(node.value);
    case Op::symbol:
      return symbol(node.symbol);
    case Op::add:
      return left() + right();
    case Op::subtract:
      return left() - right();
    case Op::multiply:
      return left() * right();
    case Op::divide:
      return left() / right();
    case Op::negate:
      return -left();
    case Op::power:
      return whole_power(left(), node.exponent);
    case Op::sin:
      return sin(left());
    case Op::cos:
      return cos(left());
    case Op::tan: {
      const T x = left();
      return sin(x) / cos(x);
    }
    case Op::asin: {
      const T x = left();
      return atan2(x, sqrt((T(1) - x) * (T(1) + x)));
    }
    case Op::acos: {
      const T x = left();
      return atan2(sqrt((T(1) - x) * (T(1) + x)), x);
    }
    case Op::atan:
      return atan2(left(), T(1));
    case Op::atan2:
      return atan2(left(), right());
    case Op::sqrt:
      return sqrt(left());
    case Op::exp:
      return exp(left());
    case Op::log:
      return log(left());
  }
  return T(0);
}

}  // namespace detail

/// The formula's value on any scalar T that has arithmetic, sin, cos, atan2, sqrt, exp and log;
/// `symbol(number)` gives each symbol's value as a T.
template <class T, class Lookup>
T evaluate(const Formula& formula, const Lookup& symbol) {
  return detail::evaluate_node<T>(formula, static_cast<int>(formula.nodes.size()) - 1, symbol);
}

}  // namespace mixloop
