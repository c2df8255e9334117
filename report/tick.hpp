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

/// All that is known of one tick of a run; the rest is kUnknown. SI, radians.
struct Tick {
  explicit Tick(std::size_t n, std::size_t m = 0)
      : psi(n, kUnknown), psid(psi), psi_desired(psi), tau(psi), tau_applied(psi), q(m, kUnknown) {}

  std::int64_t k = 0;
  double t = kUnknown;
  std::vector<double> psi, psid, psi_desired;  ///< n
  std::vector<double> tau, tau_applied;        ///< n, commanded, and after the plant's limits and delay
  std::vector<double> q;                       ///< m
  Motion desired, actual;
  double kinetic_energy = kUnknown, potential_energy = kUnknown, work = kUnknown;  ///< J
  double command_age = kUnknown;  ///< s, from STATE(k) to COMMAND(k) as the logger received them
};

// A tick's parts by the names that trajectories and curves give them: psi_1, ..., position_x_desired, ...
inline constexpr std::pair<const char*, std::vector<double> Tick::*> kByMotor[] = {
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
