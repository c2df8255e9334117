// SPDX-License-Identifier: MIT
// A mechanism of three unit masses under a PD law: enough of a plant, controller and plan to drive the
// runtime's three peers, and to say in one process which commands must come about.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "mixloop_lcm/fields.hpp"
#include "notation/sha256.hpp"

namespace mixloop::toy {

inline constexpr int kN = 3;
inline constexpr std::int64_t kConfig = 0x0001000200030004;

struct Plant {
  std::array<double, kN> psi{0.1, 0.2, 0.3}, psid{};

  void measure(std::span<double> psi_out, std::span<double> psid_out) const {
    for (int i = 0; i < kN; ++i) {
      psi_out[i] = psi[i];
      psid_out[i] = psid[i];
    }
  }
  void advance(std::span<const double> tau) {
    for (int i = 0; i < kN; ++i) {
      psid[i] += 1e-3 * tau[i];
      psi[i] += 1e-3 * psid[i];
    }
  }
};

inline void refer(std::int64_t tick, reference_t& r) {
  for (int i = 0; i < kN; ++i) {
    const double phase = 1e-3 * static_cast<double>(tick) * (i + 1);
    r.psi_desired[i] = std::sin(phase);
    r.psid_desired[i] = (i + 1) * std::cos(phase);
    r.psidd_desired[i] = -(i + 1) * (i + 1) * std::sin(phase);
  }
}

inline void compute(std::span<const double> psi, std::span<const double> psid, const reference_t& r,
                    std::span<double> tau) {
  for (int i = 0; i < kN; ++i)
    tau[i] = 100 * (r.psi_desired[i] - psi[i]) + 20 * (r.psid_desired[i] - psid[i]) + r.psidd_desired[i];
}

/// SHA-256 over the commands of ticks 0 to `last_tick`.
inline std::string digest(const std::vector<double>& commands) {
  Sha256 sha;
  sha.add(std::span<const double>(commands));
  return sha.hex();
}

inline std::string expected_digest(std::int64_t last_tick) {
  Plant plant;
  reference_t r{};
  r.psi_desired.resize(kN);
  r.psid_desired.resize(kN);
  r.psidd_desired.resize(kN);
  std::vector<double> commands;
  std::array<double, kN> tau{};
  for (std::int64_t k = 0; k <= last_tick; ++k) {
    refer(k, r);
    compute(plant.psi, plant.psid, r, tau);
    commands.insert(commands.end(), tau.begin(), tau.end());
    plant.advance(tau);
  }
  return digest(commands);
}

}  // namespace mixloop::toy
