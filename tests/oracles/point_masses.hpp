// SPDX-License-Identifier: MIT
// Dynamics by virtual work over point masses whose places are closed formulas of a few coordinates w: no
// joints, no frames' derivatives, no closures. An oracle: sum m (p'' - g) . dp/dw_i = sum_k tau_k
// dpsi_k/dw_i.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Dense>

namespace mixloop::oracle {

/// A quantity and its first two derivatives along a line.
struct Jet {
  double v = 0, d = 0, dd = 0;

  Jet() = default;
  Jet(double value) : v(value) {}  // NOLINT(google-explicit-constructor): numbers stand in formulas
  Jet(double value, double first, double second) : v(value), d(first), dd(second) {}

  /// f(a) of f, f' and f'' at a.
  Jet through(double f, double f1, double f2) const { return {f, f1 * d, f1 * dd + f2 * d * d}; }
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
inline Jet operator-(const Jet& a) { return {-a.v, -a.d, -a.dd}; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  return a * b.through(1 / b.v, -1 / (b.v * b.v), 2 / (b.v * b.v * b.v));
}
inline Jet sqrt(const Jet& a) {
  const double r = std::sqrt(a.v);
  return a.through(r, 0.5 / r, -0.25 / (r * a.v));
}
inline Jet sin(const Jet& a) { return a.through(std::sin(a.v), std::cos(a.v), -std::sin(a.v)); }
inline Jet cos(const Jet& a) { return a.through(std::cos(a.v), -std::sin(a.v), -std::cos(a.v)); }
/// (x y' - y x') / r^2, and its derivative.
inline Jet atan2(const Jet& y, const Jet& x) {
  const double r2 = x.v * x.v + y.v * y.v, turn = (x.v * y.d - y.v * x.d) / r2;
  return {std::atan2(y.v, x.v), turn, (x.v * y.dd - y.v * x.dd - 2 * turn * (x.v * x.d + y.v * y.d)) / r2};
}

using Jet3 = std::array<Jet, 3>;

inline Jet3 operator+(const Jet3& a, const Jet3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Jet3 operator-(const Jet3& a, const Jet3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Jet3 operator*(const Jet3& a, const Jet& s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline Jet dot(const Jet3& a, const Jet3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where a mechanism's motors and masses are.
struct Masses {
  struct Point {
    double mass;
    Jet3 place;
  };
  std::vector<Jet> motors;
  std::vector<Point> points;

  void add(double mass, const Jet3& place) { points.push_back({mass, place}); }
  /// A rigid body, by six points that have its mass, its centre and its moments of inertia about the centre:
  /// two along each axis, at a distance r with m r^2 / 3 = (I_xx + I_yy + I_zz) / 2 - I_kk.
  void add(double mass, const Jet3& centre, const std::array<Jet3, 3>& axes,
           const std::array<double, 3>& inertia) {
    const double half = (inertia[0] + inertia[1] + inertia[2]) / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const double r = std::sqrt(3 * std::max(half - inertia[k], 0.0) / mass);
      add(mass / 6, centre + axes[k] * r);
      add(mass / 6, centre - axes[k] * r);
    }
  }
  /// A slender bar between two places.
  void add_bar(double mass, const Jet3& from, const Jet3& to) {
    // m/6 at the ends and 2m/3 in the middle: moments m L^2 / 12.
    add(mass / 6, from);
    add(mass / 6, to);
    add(mass * 2 / 3, (from + to) * 0.5);
  }
};

class VirtualWork {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using Placing = std::function<Masses(const std::vector<Jet>& w)>;

  VirtualWork(Placing placing, std::array<double, 3> gravity)
      : placing_(std::move(placing)), gravity_(gravity) {}

  struct Motors {
    Vector psi, psid, psidd;
  };
  Motors motors(const Vector& w, const Vector& wd, const Vector& wdd) const {
    const auto all = along(w, wd, wdd).motors;
    Motors motors{Vector(count(all)), Vector(count(all)), Vector(count(all))};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      motors.psi[i] = all[k].v, motors.psid[i] = all[k].d, motors.psidd[i] = all[k].dd;
    }
    return motors;
  }

  /// The motors' efforts that w'' takes.
  Vector inverse(const Vector& w, const Vector& wd, const Vector& wdd) const {
    const Slopes slopes = slopes_at(w);
    return slopes.motors.transpose().fullPivLu().solve(taken(slopes, along(w, wd, wdd)));
  }
  /// w'' at the motors' efforts.
  Vector forward(const Vector& w, const Vector& wd, const Vector& tau) const {
    const Slopes slopes = slopes_at(w);
    const Vector none = Vector::Zero(w.size()), bias = taken(slopes, along(w, wd, none));
    Matrix M(w.size(), w.size());
    for (Eigen::Index i = 0; i < w.size(); ++i)
      M.col(i) = taken(slopes, along(w, wd, Vector::Unit(w.size(), i))) - bias;
    return M.ldlt().solve(slopes.motors.transpose() * tau - bias);
  }

 private:
  /// By each of w: of the motors, and of all places one after the other.
  struct Slopes {
    Matrix motors, places;
  };

  static Eigen::Index count(const std::vector<Jet>& all) { return static_cast<Eigen::Index>(all.size()); }

  Masses along(const Vector& w, const Vector& wd, const Vector& wdd) const {
    std::vector<Jet> jets;
    for (Eigen::Index i = 0; i < w.size(); ++i) jets.emplace_back(w[i], wd[i], wdd[i]);
    return placing_(jets);
  }
  Slopes slopes_at(const Vector& w) const {
    Slopes slopes;
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      const Masses by = along(w, Vector::Unit(w.size(), i), Vector::Zero(w.size()));
      if (i == 0) {
        slopes.motors.resize(count(by.motors), w.size());
        slopes.places.resize(3 * static_cast<Eigen::Index>(by.points.size()), w.size());
      }
      for (std::size_t k = 0; k < by.motors.size(); ++k)
        slopes.motors(static_cast<Eigen::Index>(k), i) = by.motors[k].d;
      for (std::size_t p = 0; p < by.points.size(); ++p)
        for (std::size_t k = 0; k < 3; ++k)
          slopes.places(static_cast<Eigen::Index>(3 * p + k), i) = by.points[p].place[k].d;
    }
    return slopes;
  }
  Vector taken(const Slopes& slopes, const Masses& at) const {
    Vector force(slopes.places.rows());
    for (std::size_t p = 0; p < at.points.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k)
        force[static_cast<Eigen::Index>(3 * p + k)] =
            at.points[p].mass * (at.points[p].place[k].dd - gravity_[k]);
    return slopes.places.transpose() * force;
  }

  Placing placing_;
  std::array<double, 3> gravity_;
};

}  // namespace mixloop::oracle
