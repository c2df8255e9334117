// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace mixloop {

/// What is desired at one instant: motors and, in the inertial frame, the end effector. SI, radians.
/// A view: who makes one keeps the numbers.
struct Reference {
  using Values = Eigen::Map<const Eigen::VectorXd>;
  using Triple = Eigen::Map<const Eigen::Vector3d>;

  Values psi, psid, psidd;  ///< n each
  Triple position, velocity, acceleration;
};

/// How many numbers a reference has for n motors.
constexpr std::size_t reference_size(int n) { return 3 * static_cast<std::size_t>(n) + 9; }

/// The reference in a row of reference_size(n) numbers: psi, psid, psidd, position, velocity, acceleration.
inline Reference reference_in(std::span<const double> row, int n) {
  const double* at = row.data();
  const double* E = at + 3 * n;
  return {{at, n},
          {at + n, n},
          {at + 2 * n, n},
          Reference::Triple(E),
          Reference::Triple(E + 3),
          Reference::Triple(E + 6)};
}

/// A reference some time after one that is known, to second order: x + x' dt + x'' dt^2 / 2, x' + x'' dt,
/// x''.
class ExtrapolatedReference {
 public:
  explicit ExtrapolatedReference(int n) : n_(n), row_(reference_size(n)) {}

  /// `dt` in s. What is returned is a view of this, until the next call. Allocates nothing.
  Reference take(const Reference& from, double dt) {
    const auto go_on = [dt](auto x, auto v, auto a, double* to) {
      const auto size = static_cast<std::size_t>(x.size());
      for (std::size_t i = 0; i < size; ++i) {
        const auto j = static_cast<Eigen::Index>(i);
        to[i] = x[j] + v[j] * dt + 0.5 * a[j] * dt * dt;
        to[size + i] = v[j] + a[j] * dt;
        to[2 * size + i] = a[j];
      }
    };
    go_on(from.psi, from.psid, from.psidd, row_.data());
    go_on(from.position, from.velocity, from.acceleration, row_.data() + 3 * n_);
    return reference_in(row_, n_);
  }

 private:
  int n_;
  std::vector<double> row_;
};

}  // namespace mixloop
