// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace mixloop {

/// What a program is for. Each holds only what its outputs need; matrices stand column by column.
enum class Purpose : std::uint8_t {
  forward_dynamics,         ///< tau (n) -> psidd (n)
  mass_times,               ///< a (n) -> M a (n), the feed-forward
  mass_matrix,              ///< -> M (n x n)
  bias,                     ///< -> h (n)
  inverse_dynamics,         ///< psidd (n) -> M psidd + h (n)
  end_effector,             ///< psidd (n) -> position, velocity, acceleration (3 each), Jacobian (3 x n)
  energy,                   ///< -> kinetic, potential
  linearisation,            ///< tau (n) -> d psidd / d psi, d psidd / d psid, d psidd / d tau (n x n each)
  dynamics_and_mass_times,  ///< tau, a (n each) -> psidd, M a (n each), in one graph
};

constexpr std::array kPurposes = {
    Purpose::forward_dynamics,        Purpose::mass_times,   Purpose::mass_matrix, Purpose::bias,
    Purpose::inverse_dynamics,        Purpose::end_effector, Purpose::energy,      Purpose::linearisation,
    Purpose::dynamics_and_mass_times,
};

/// Its identifier, e.g. "forward_dynamics".
constexpr std::string_view name_of(Purpose purpose) {
  constexpr std::array<std::string_view, kPurposes.size()> kNames = {
      "forward_dynamics",       "mass_times",   "mass_matrix", "bias",
      "inverse_dynamics",       "end_effector", "energy",      "linearisation",
      "dynamics_and_mass_times"};
  return kNames[static_cast<std::size_t>(purpose)];
}

/// How many numbers it takes beside psi, psid and t, for n independent coordinates.
constexpr int input_size(Purpose purpose, int n) {
  switch (purpose) {
    case Purpose::forward_dynamics:
    case Purpose::mass_times:
    case Purpose::inverse_dynamics:
    case Purpose::end_effector:
    case Purpose::linearisation:
      return n;
    case Purpose::dynamics_and_mass_times:
      return 2 * n;
    default:
      return 0;
  }
}

/// How many numbers it gives.
constexpr int output_size(Purpose purpose, int n) {
  switch (purpose) {
    case Purpose::mass_matrix:
      return n * n;
    case Purpose::end_effector:
      return 9 + 3 * n;
    case Purpose::energy:
      return 2;
    case Purpose::linearisation:
      return 3 * n * n;
    case Purpose::dynamics_and_mass_times:
      return 2 * n;
    default:
      return n;
  }
}

}  // namespace mixloop
