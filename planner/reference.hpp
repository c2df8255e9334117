// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

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

}  // namespace mixloop
