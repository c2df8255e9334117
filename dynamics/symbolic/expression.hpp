// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dynamics/symbolic/graph.hpp"

namespace mixloop {

/// The recording scalar: a number, or a node of the graph that this thread records on.
///
/// A procedure templated on its scalar, run on Expression, leaves in the graph what it computed. Numbers
/// stay numbers, so that whatever is constant folds away and needs no graph. A branch on a number is
/// fine; a branch on a node throws std::logic_error, for it cannot be recorded.
class Expression {
 public:
  Expression() = default;
  Expression(double value) : value_(value) {}  // NOLINT: a number is an expression
  Expression(int value) : value_(value) {}     // NOLINT
  static Expression of(NodeId id);
  static Expression input(Block block, std::size_t index);

  bool is_number() const { return !is_node_; }
  /// The number; std::logic_error for a node.
  double number() const;
  /// The node in the recording graph, made for a number.
  NodeId node() const;

  explicit operator double() const { return number(); }

  Expression operator-() const;
  Expression& operator+=(const Expression& y) { return *this = *this + y; }
  Expression& operator-=(const Expression& y) { return *this = *this - y; }
  Expression& operator*=(const Expression& y) { return *this = *this * y; }
  Expression& operator/=(const Expression& y) { return *this = *this / y; }

  friend Expression operator+(const Expression& x, const Expression& y) { return binary(Op::add, x, y); }
  friend Expression operator-(const Expression& x, const Expression& y) { return binary(Op::sub, x, y); }
  friend Expression operator*(const Expression& x, const Expression& y) { return binary(Op::mul, x, y); }
  friend Expression operator/(const Expression& x, const Expression& y) { return binary(Op::div, x, y); }

  friend bool operator==(const Expression& x, const Expression& y) { return x.number() == y.number(); }
  friend bool operator!=(const Expression& x, const Expression& y) { return x.number() != y.number(); }
  friend bool operator<(const Expression& x, const Expression& y) { return x.number() < y.number(); }
  friend bool operator>(const Expression& x, const Expression& y) { return x.number() > y.number(); }
  friend bool operator<=(const Expression& x, const Expression& y) { return x.number() <= y.number(); }
  friend bool operator>=(const Expression& x, const Expression& y) { return x.number() >= y.number(); }

  /// As Graph::held; a number is itself.
  static Expression held(const Expression& x, unsigned tag);
  static Expression unary(Op op, const Expression& x);
  static Expression binary(Op op, const Expression& x, const Expression& y);

 private:
  double value_ = 0.0;
  NodeId id_ = 0;
  bool is_node_ = false;
};

inline Expression sqrt(const Expression& x) { return Expression::unary(Op::sqrt, x); }
inline Expression sin(const Expression& x) { return Expression::unary(Op::sin, x); }
inline Expression cos(const Expression& x) { return Expression::unary(Op::cos, x); }
inline Expression exp(const Expression& x) { return Expression::unary(Op::exp, x); }
inline Expression log(const Expression& x) { return Expression::unary(Op::log, x); }
inline Expression atan2(const Expression& y, const Expression& x) {
  return Expression::binary(Op::atan2, y, x);
}
inline const Expression& conj(const Expression& x) { return x; }
inline const Expression& real(const Expression& x) { return x; }
inline Expression imag(const Expression&) { return 0.0; }
inline Expression abs2(const Expression& x) { return x * x; }
inline bool isfinite(const Expression&) { return true; }
/// Whether it is known to be nothing.
inline bool is_zero(const Expression& x) { return x.is_number() && x.number() == 0.0; }

/// While it lives, this thread's expressions are recorded on the graph.
class Recording {
 public:
  explicit Recording(Graph& graph);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

 private:
  Graph* before_;
};

/// The graph that this thread records on; std::logic_error if there is none.
Graph& recording_graph();

}  // namespace mixloop

namespace Eigen {
template <>
struct NumTraits<mixloop::Expression> : GenericNumTraits<double> {
  using Real = mixloop::Expression;
  using NonInteger = mixloop::Expression;
  using Nested = mixloop::Expression;
  using Literal = mixloop::Expression;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
  static Real epsilon() { return std::numeric_limits<double>::epsilon(); }
  static Real dummy_precision() { return 1e-12; }
  static int digits10() { return std::numeric_limits<double>::digits10; }
};
}  // namespace Eigen
