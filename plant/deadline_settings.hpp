// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "dynamics/procedure/matrix.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What a plant does once it no longer trusts its commands.
enum class SafeState : std::uint8_t {
  hold,         ///< the drives hold where they stood, by their own servo: tau = Kp (psi_0 - psi) - Kv psi'
  damp,         ///< tau = -Kv psi'
  zero_torque,  ///< tau = 0
  brake,        ///< the motors lock at once where they stand
};
std::string_view name_of(SafeState state);

/// What holds for a plant in real time, where commands have a deadline.
struct DeadlineSettings {
  int max_missed = 20;  ///< more commands missed in a row than this bring the safe state
  SafeState safe_state = SafeState::hold;
  Vector kp, kv;  ///< n_u: the drives' own servo, for hold and damp
};

/// Reads `{max_missed, safe_state}`; the gains are not its own.
DeadlineSettings read_deadline_settings(const NodePtr& node);

}  // namespace mixloop
