// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "controller/control_law.hpp"

namespace mixloop {

/// How a command came to be, beside the law.
struct CommandMarks {
  bool limited = false;  ///< a torque or rate limit was at work
  bool safe = false;     ///< the safe command, in place of the law's
};

/// A control law under its safety settings: limits on what it commands, and a safe command in place of it
/// where the state can't be trusted. A state out of range latches that until begin(); a stale one does while
/// it lasts. Nothing allocates after construction.
class GuardedController {
 public:
  /// `damping` (n_u): for SafeCommand::damp.
  GuardedController(Controller controller, SafetySettings settings, Vector damping);

  /// A new session: nothing is remembered.
  void begin();

  /// Says what is wrong where the robot stands too far from where the path starts; empty where nothing is.
  std::string start_refusal(std::span<const double> psi, const Reference& start) const;

  /// tau (n_u).
  CommandMarks torque(const Measurement& now, const Reference& desired, std::span<double> tau);

  /// The safe command on its own, where no state or reference came. Nothing is remembered of it.
  void safe_torque(std::span<double> tau) const;

  /// The motor whose state was out of range, counted from 1.
  std::optional<int> out_of_range() const { return out_of_range_; }

  /// The law alone.
  Controller& law() { return controller_; }

 private:
  CommandMarks safe(std::span<double> tau) const { return safe_torque(tau), CommandMarks{.safe = true}; }
  bool in_range(const Measurement& now);
  bool limit(double t, std::span<double> tau);

  Controller controller_;
  SafetySettings settings_;
  Vector damping_;
  Vector trusted_psid_;         ///< n_u, of the last state that was trusted
  Vector before_;               ///< the law's last command
  std::optional<double> when_;  ///< s, that of the law's last command
  std::optional<int> out_of_range_;
  int stale_ = 0;  ///< states in a row
};

}  // namespace mixloop
