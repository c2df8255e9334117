// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <concepts>

#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {

/// A number as the sum of two doubles, about 104 bits: what tracing computes coefficients in before they
/// become doubles, to the same bits on every machine (a long double has 53, 64 or 113). Sums and products by
/// Dekker and Knuth; relative error below 2^-100 unless a sum cancels.
class DoubleDouble {
 public:
  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high_(value) {}  // NOLINT: a number is one
  template <std::integral Whole>
  constexpr DoubleDouble(Whole value) : high_(static_cast<double>(value)) {}  // NOLINT
  constexpr DoubleDouble(double high, double low) : high_(high), low_(low) {}

  constexpr double high() const { return high_; }
  constexpr double low() const { return low_; }
  explicit operator double() const { return high_; }
  explicit operator long() const { return static_cast<long>(high_); }

  DoubleDouble operator-() const { return {-high_, -low_}; }
  DoubleDouble& operator+=(const DoubleDouble& y) { return *this = *this + y; }
  DoubleDouble& operator-=(const DoubleDouble& y) { return *this = *this - y; }
  DoubleDouble& operator*=(const DoubleDouble& y) { return *this = *this * y; }
  DoubleDouble& operator/=(const DoubleDouble& y) { return *this = *this / y; }

  friend DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble s = two_sum(x.high_, y.high_), t = two_sum(x.low_, y.low_);
    const DoubleDouble v = quick_sum(s.high_, s.low_ + t.high_);
    return quick_sum(v.high_, v.low_ + t.low_);
  }
  friend DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) { return x + -y; }
  friend DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
    const double p = x.high_ * y.high_;
    return quick_sum(p, mixloop_functions::fma(x.high_, y.high_, -p) + (x.high_ * y.low_ + x.low_ * y.high_));
  }
  friend DoubleDouble operator/(const DoubleDouble& x, const DoubleDouble& y) {
    const double first = x.high_ / y.high_;
    DoubleDouble rest = x - y * first;
    const double second = rest.high_ / y.high_;
    rest -= y * second;
    return quick_sum(first, second) + DoubleDouble(rest.high_ / y.high_);
  }

  friend bool operator==(const DoubleDouble& x, const DoubleDouble& y) {
    return x.high_ == y.high_ && x.low_ == y.low_;
  }
  friend bool operator!=(const DoubleDouble& x, const DoubleDouble& y) { return !(x == y); }
  friend bool operator<(const DoubleDouble& x, const DoubleDouble& y) {
    return x.high_ < y.high_ || (x.high_ == y.high_ && x.low_ < y.low_);
  }
  friend bool operator>(const DoubleDouble& x, const DoubleDouble& y) { return y < x; }
  friend bool operator<=(const DoubleDouble& x, const DoubleDouble& y) { return !(y < x); }
  friend bool operator>=(const DoubleDouble& x, const DoubleDouble& y) { return !(x < y); }

 private:
  static DoubleDouble two_sum(double x, double y) {
    const double s = x + y, part = s - x;
    return {s, (x - (s - part)) + (y - part)};
  }
  static DoubleDouble quick_sum(double x, double y) {  // |x| >= |y|
    const double s = x + y;
    return {s, y - (s - x)};
  }

  double high_ = 0, low_ = 0;
};

inline constexpr DoubleDouble kPi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

inline DoubleDouble abs(const DoubleDouble& x) { return x < 0.0 ? -x : x; }
inline bool isfinite(const DoubleDouble& x) { return std::isfinite(x.high()); }
DoubleDouble floor(const DoubleDouble& x);
/// To the nearest whole number; halves upwards.
inline DoubleDouble round(const DoubleDouble& x) { return floor(x + 0.5); }
/// x - y round(x / y)
inline DoubleDouble remainder(const DoubleDouble& x, const DoubleDouble& y) { return x - y * round(x / y); }
DoubleDouble sqrt(const DoubleDouble& x);
/// Of angles below 1e6 rad.
DoubleDouble sin(const DoubleDouble& x);
DoubleDouble cos(const DoubleDouble& x);
DoubleDouble atan2(const DoubleDouble& y, const DoubleDouble& x);

}  // namespace mixloop

namespace Eigen {
template <>
struct NumTraits<mixloop::DoubleDouble> : GenericNumTraits<double> {
  using Real = mixloop::DoubleDouble;
  using NonInteger = mixloop::DoubleDouble;
  using Nested = mixloop::DoubleDouble;
  using Literal = mixloop::DoubleDouble;
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 8,
    MulCost = 8
  };
  static Real epsilon() { return 0x1p-104; }
  static Real dummy_precision() { return 1e-28; }
};
}  // namespace Eigen
