// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "loop/measures.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What an experiment must show: bounds on what is measured, or that it diverges.
struct Expectation {
  struct Bound {
    std::string name;          ///< of the measure, e.g. "max_position_error"
    std::optional<int> motor;  ///< which element of a measure that has one a motor, or a coordinate
    double least = 0, most = 0;
    std::string unit;  ///< of the two and of what is measured, in SI; empty: a pure number
    double value_in(const Measures& measures) const;
    /// Not of what was never measured.
    bool holds(double value) const { return value >= least && value <= most; }
  };
  std::vector<Bound> bounds;
  bool diverges = false;
  bool safe_state = false;  ///< in real time: the plant goes into its safe state

  /// Whether there is a bound on this measure.
  bool bounds_on(std::string_view name) const;
};

/// Reads `{max_position_error: 13.3 mm, max_torque: [2, 5, 3], final: [0.1 rad], tolerance: 1e-6,
/// energy_drift: 1e-9, diverges: true}`; a bound may be a pair [least, most] where a measure is a single
/// number. Throws InputError, also for what no run can show whose position error stays below
/// `position_error_limit` (m) until it has diverged; none: no end effector follows a path, and there is no
/// position error. `is_of_motors`: its path is of the motors, whose errors are told.
Expectation read_expectation(const NodePtr& node, const Scene& scene,
                             std::optional<double> position_error_limit, bool is_of_motors = false);

/// What was missed, a line each; empty where all is held.
std::vector<std::string> missed(const Expectation& expectation, const Measures& measures);

}  // namespace mixloop
