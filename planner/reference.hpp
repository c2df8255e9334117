// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "planner/motion.hpp"

namespace mixloop {

/// What is desired at one instant: motors and, in the inertial frame, the end effector. SI, radians.
/// A view: who makes one keeps the numbers.
struct Reference {
  using Values = Eigen::Map<const Eigen::VectorXd>;
  using Triple = Eigen::Map<const Eigen::Vector3d>;

  Values psi, psid, psidd;  ///< n_u each
  Triple position, velocity, acceleration;
};

/// How many numbers a reference has for n_u motors.
constexpr std::size_t reference_size(int n_u) { return 3 * static_cast<std::size_t>(n_u) + 9; }

/// The reference in a row of reference_size(n_u) numbers: psi, psid, psidd, position, velocity, acceleration.
inline Reference reference_in(std::span<const double> row, int n_u) {
  const double* at = row.data();
  const double* E = at + 3 * n_u;
  return {{at, n_u},
          {at + n_u, n_u},
          {at + 2 * n_u, n_u},
          Reference::Triple(E),
          Reference::Triple(E + 3),
          Reference::Triple(E + 6)};
}

/// Of all independent coordinates, the free ones at rest at home.
inline PsiMotion whole_motion(const Scene& scene, const Reference& reference) {
  return with_free_at_home(scene, {reference.psi, reference.psid, reference.psidd});
}

/// A reference some time after one that is known, to second order: x + x' dt + x'' dt^2 / 2, x' + x'' dt,
/// x''.
class ExtrapolatedReference {
 public:
  explicit ExtrapolatedReference(int n_u) : n_u_(n_u), row_(reference_size(n_u)) {}

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
    go_on(from.position, from.velocity, from.acceleration, row_.data() + 3 * n_u_);
    return reference_in(row_, n_u_);
  }

 private:
  int n_u_;
  std::vector<double> row_;
};

}  // namespace mixloop
