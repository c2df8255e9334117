// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>

#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

/// A double that counts what is computed with it: the procedure on it tells what it takes as it stands.
class Counted {
 public:
  Counted() = default;
  Counted(double value) : value_(value) {}  // NOLINT: a number is one

  double value() const { return value_; }
  /// What this thread has computed since it was last reset.
  static OperationCount& count() {
    static thread_local OperationCount counted;
    return counted;
  }

  Counted operator-() const { return -value_; }
  Counted& operator+=(const Counted& y) { return *this = *this + y; }
  Counted& operator-=(const Counted& y) { return *this = *this - y; }
  Counted& operator*=(const Counted& y) { return *this = *this * y; }
  Counted& operator/=(const Counted& y) { return *this = *this / y; }

  friend Counted operator+(const Counted& x, const Counted& y) { return of(Op::add, x, y); }
  friend Counted operator-(const Counted& x, const Counted& y) { return of(Op::sub, x, y); }
  friend Counted operator*(const Counted& x, const Counted& y) { return of(Op::mul, x, y); }
  friend Counted operator/(const Counted& x, const Counted& y) { return of(Op::div, x, y); }
  friend Counted sqrt(const Counted& x) { return of(Op::sqrt, x); }
  // A sine and its cosine are one pair, counted with the sine.
  friend Counted sin(const Counted& x) { return of(Op::sin, x); }
  friend Counted cos(const Counted& x) { return apply(Op::cos, x.value_); }
  friend Counted exp(const Counted& x) { return of(Op::exp, x); }
  friend Counted log(const Counted& x) { return of(Op::log, x); }
  friend bool operator<(const Counted& x, const Counted& y) { return x.value_ < y.value_; }
  friend bool operator>(const Counted& x, const Counted& y) { return x.value_ > y.value_; }
  friend bool operator<=(const Counted& x, const Counted& y) { return x.value_ <= y.value_; }
  friend Counted abs(const Counted& x) { return std::abs(x.value_); }
  friend Counted atan2(const Counted& y, const Counted& x) { return of(Op::atan2, y, x); }

 private:
  static Counted of(Op op, const Counted& x, const Counted& y = 0.0) {
    ++(count().*operation(op).count);
    return apply(op, x.value_, y.value_);
  }

  double value_ = 0.0;
};

}  // namespace mixloop

template <>
struct std::numeric_limits<mixloop::Counted> : std::numeric_limits<double> {};

namespace Eigen {
template <>
struct NumTraits<mixloop::Counted> : GenericNumTraits<double> {
  using Real = mixloop::Counted;
  using NonInteger = mixloop::Counted;
  using Nested = mixloop::Counted;
  using Literal = mixloop::Counted;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
}  // namespace Eigen
