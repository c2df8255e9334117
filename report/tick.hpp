// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace mixloop {

/// What a result or a log doesn't tell.
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Of the end effector, in frame 0: m, m/s, m/s^2.
struct Motion {
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d velocity = position, acceleration = position;
};

/// How many coordinates a run has: independent ones, of them motors, and dependent ones.
struct RunSizes {
  std::size_t n = 0, n_u = 0, m = 0;
};

/// All that is known of one tick of a run; the rest is kUnknown. SI, radians.
struct Tick {
  explicit Tick(const RunSizes& sizes)
      : psi(sizes.n, kUnknown),
        psid(psi),
        psi_desired(sizes.n_u, kUnknown),
        tau(psi_desired),
        tau_applied(psi_desired),
        q(sizes.m, kUnknown) {}

  std::int64_t k = 0;
  double t = kUnknown;
  bool judged = true;  ///< neither on the move to the path's start nor in the safe state, as far as is told
  std::vector<double> psi, psid;         ///< n
  std::vector<double> psi_desired;       ///< n_u
  std::vector<double> tau, tau_applied;  ///< n_u, commanded, and after the plant's limits and delay
  std::vector<double> q;                 ///< m
  Motion desired, actual;
  double kinetic_energy = kUnknown, potential_energy = kUnknown, work = kUnknown;  ///< J
  double command_age = kUnknown;  ///< s, from STATE(k) to COMMAND(k) as the logger received them
};

// A tick's parts by the names that trajectories and curves give them: psi_1, ..., position_x_desired, ...
inline constexpr std::pair<const char*, std::vector<double> Tick::*> kByCoordinate[] = {
    {"psi", &Tick::psi},
    {"psid", &Tick::psid},
    {"psi_desired", &Tick::psi_desired},
    {"tau", &Tick::tau},
    {"tau_applied", &Tick::tau_applied}};
inline constexpr std::pair<const char*, Motion Tick::*> kMotions[] = {{"desired", &Tick::desired},
                                                                      {"actual", &Tick::actual}};
inline constexpr std::pair<const char*, Eigen::Vector3d Motion::*> kOfAMotion[] = {
    {"position", &Motion::position},
    {"velocity", &Motion::velocity},
    {"acceleration", &Motion::acceleration}};

}  // namespace mixloop
