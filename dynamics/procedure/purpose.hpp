// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace mixloop {

/// What a program is for. Each holds only what its outputs need.
enum class Purpose : std::uint8_t {
  forward_dynamics,
  mass_times,  ///< the feed-forward; what moves freely is taken not to accelerate
  mass_matrix,
  bias,
  inverse_dynamics,
  end_effector,
  energy,
  linearisation,
  dynamics_and_mass_times,  ///< both in one graph
};

/// What a purpose takes beside psi, psid and t, and what it gives, for n independent coordinates of which
/// motors drive n_u. Matrices stand column by column.
struct Signature {
  Purpose purpose;
  std::string_view name, takes, gives;
  int (*input_size)(int n, int n_u);
  int (*output_size)(int n, int n_u);
  bool gives_psidd;  ///< before all else
  bool has_forces;   ///< what velocities, gravity and loads take has a share in it
};

inline constexpr std::array kSignatures = {
    Signature{Purpose::forward_dynamics, "forward_dynamics", "tau (n_u)", "psidd (n)",
              [](int, int n_u) { return n_u; }, [](int n, int) { return n; }, true, true},
    Signature{Purpose::mass_times, "mass_times", "a (n_u)", "M a (n_u)", [](int, int n_u) { return n_u; },
              [](int, int n_u) { return n_u; }, false, false},
    Signature{Purpose::mass_matrix, "mass_matrix", "none", "M (n x n)", [](int, int) { return 0; },
              [](int n, int) { return n * n; }, false, false},
    Signature{Purpose::bias, "bias", "none", "h (n)", [](int, int) { return 0; },
              [](int n, int) { return n; }, false, true},
    Signature{Purpose::inverse_dynamics, "inverse_dynamics", "psidd (n)", "M psidd + h (n)",
              [](int n, int) { return n; }, [](int n, int) { return n; }, false, true},
    Signature{Purpose::end_effector, "end_effector", "psidd (n)",
              "position, velocity, acceleration (3 each), Jacobian (3 x n)", [](int n, int) { return n; },
              [](int n, int) { return 9 + 3 * n; }, false, false},
    Signature{Purpose::energy, "energy", "none", "kinetic energy, potential", [](int, int) { return 0; },
              [](int, int) { return 2; }, false, false},
    Signature{Purpose::linearisation, "linearisation", "tau (n_u)",
              "d psidd / d psi, d psidd / d psid (n x n each), d psidd / d tau (n x n_u)",
              [](int, int n_u) { return n_u; }, [](int n, int n_u) { return n * (2 * n + n_u); }, false,
              true},
    Signature{Purpose::dynamics_and_mass_times, "dynamics_and_mass_times", "tau, a (n_u each)",
              "psidd (n), M a (n_u)", [](int, int n_u) { return 2 * n_u; },
              [](int n, int n_u) { return n + n_u; }, true, true},
};

constexpr const Signature& signature(Purpose purpose) {
  return kSignatures[static_cast<std::size_t>(purpose)];
}

constexpr std::array kPurposes = [] {
  std::array<Purpose, kSignatures.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Purpose>(i);
  return all;
}();
static_assert(
    [] {
      for (Purpose purpose : kPurposes)
        if (signature(purpose).purpose != purpose) return false;
      return true;
    }(),
    "a row stands where its Purpose says");

constexpr std::size_t output_size(Purpose purpose, int n, int n_u) {
  return static_cast<std::size_t>(signature(purpose).output_size(n, n_u));
}

/// Its identifier, e.g. "forward_dynamics".
constexpr std::string_view name_of(Purpose purpose) { return signature(purpose).name; }

}  // namespace mixloop
