// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// What was never measured: null in JSON, and no bound on it is held.
inline constexpr double kNeverMeasured = std::numeric_limits<double>::quiet_NaN();

/// What a run of an experiment is judged by: its ticks before the safe state, of position errors those from
/// the start of the path on.
struct Measures {
  bool follows_path = true;                    ///< the end effector does: else there are no position errors
  bool is_oriented = false;                    ///< and what it is turned to is prescribed too
  double max_position_error = kNeverMeasured;  ///< m
  double time_of_max_position_error = kNeverMeasured;  ///< s
  double final_position_error = kNeverMeasured;        ///< m, at the last tick
  double rms_position_error = kNeverMeasured;          ///< m
  double max_orientation_error =
      kNeverMeasured;                     ///< rad, of an end effector whose turn or direction is prescribed
  std::optional<Vector> max_motor_error;  ///< n_u, rad or m: along a path of the motors
  Vector max_torque;              ///< n_u, N m or N, largest magnitude of each motor's commanded torque
  std::int64_t ticks = 0;         ///< the last tick recorded; N where the run is whole
  std::string trajectory_sha256;  ///< of the doubles t, psi, psi', tau of ticks 0 to `ticks`; or empty
  /// s: from there on the position error was within what RecorderSettings say, to the last tick.
  double settled_at = kNeverMeasured;
  std::optional<double> diverged_at;  ///< s
  std::optional<std::string>
      no_way_on;  ///< why it diverged, where closures ended it: which, when, in which pose
  std::optional<double> closure_residual;  ///< m or rad, the largest; where chains close
  /// The worst of all blocks and ticks, 1 at best (trace.hpp); where coordinates are switched of those in
  /// use.
  std::optional<double> closure_condition;
  std::optional<std::int64_t> switches;  ///< to other independent coordinates, where they are switched
  std::optional<double> safe_at;         ///< s: from there on the plant was in its safe state, and not judged
  std::optional<double> interrupted_at;  ///< s
  std::optional<Vector> final_psi;       ///< n, at the last tick; without a path, or where it is expected
  /// The largest |E - E_0 - W| of all ticks over the largest |E|: E is kinetic energy and potential, W the
  /// motors' work. Without a path or where it is expected, of what keeps its energy (energy_balance.hpp).
  std::optional<double> energy_drift;
};

}  // namespace mixloop
