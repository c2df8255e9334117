// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What a controller sends when it no longer trusts what it hears.
enum class SafeCommand : std::uint8_t {
  zero_torque,
  damp,  ///< tau = -Kv psi', of the last state that was to be trusted
};

/// What a controller watches over. Empty vectors: no limit. SI units, one value a motor.
struct SafetySettings {
  std::vector<double> torque_limit;       ///< N m or N, of what it commands
  std::vector<double> torque_rate_limit;  ///< N m/s or N/s, from command to command
  std::vector<double> velocity_limit;     ///< rad/s or m/s; past it the state can't be right: safe for good
  std::vector<std::array<double, 2>> position_range;  ///< rad or m; the same
  std::vector<double>
      start_tolerance;  ///< rad or m that a motor may stand off the path's start; empty: 0.02 each
  int max_stale = 10;   ///< states in a row with stale sensors before it is safe
  SafeCommand safe_command = SafeCommand::zero_torque;
};

/// Reads `{torque_limit, torque_rate_limit, velocity_limit, position_range, start_tolerance, max_stale,
/// safe_command}`.
SafetySettings read_safety_settings(const NodePtr& node, const Scene& scene);

}  // namespace mixloop
