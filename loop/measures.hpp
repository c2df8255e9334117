// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// What a run of an experiment is judged by. Position errors count from the start of the path, at the ticks.
struct Measures {
  double max_position_error = 0;          ///< m
  double time_of_max_position_error = 0;  ///< s
  double final_position_error = 0;        ///< m, at the last tick
  double rms_position_error = 0;          ///< m
  Vector max_torque;                      ///< n_u, largest magnitude of each motor's commanded torque
  std::int64_t ticks = 0;                 ///< the last tick recorded; N where the run is whole
  std::string trajectory_sha256;          ///< of the doubles t, psi, psi', tau of ticks 0 to `ticks`
  std::optional<double> diverged_at;      ///< s
  std::optional<double> safe_at;         ///< s: from there on the plant was in its safe state, and not judged
  std::optional<double> interrupted_at;  ///< s
};

}  // namespace mixloop
