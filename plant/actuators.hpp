// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// What the drives make of the torque asked of them. Vectors have a value a motor, in N m and rad or N and m;
/// empty: not so.
struct ActuatorSettings {
  std::vector<double> rate_limit;       ///< N m/s
  std::vector<double> time_constant;    ///< s, of a first-order lag; 0: none
  std::vector<double> ripple;           ///< largest share of the torque
  std::vector<double> ripple_per_turn;  ///< periods in a turn of the motor
  std::vector<double> viscous;          ///< N m s
  std::vector<double> coulomb;          ///< N m
  std::vector<double> smooth;           ///< rad/s: c tanh(psi' / smooth) stands for Coulomb's c sign(psi')

  bool any() const { return has_memory() || !ripple.empty() || has_friction(); }
  bool has_memory() const { return !rate_limit.empty() || !time_constant.empty(); }
  bool has_friction() const { return !viscous.empty() || !coulomb.empty(); }
};

/// Reads `{rate_limit, time_constant, ripple: {amplitude, per_turn}, friction: {viscous, coulomb, smooth}}`.
ActuatorSettings read_actuator_settings(const NodePtr& node, const Scene& scene);

/// The drives. A torque asked for (after dead time and saturation) goes through rate limit and lag, which
/// have closed forms as long as it stays:
///   r(s) = r0 + sign(u - r0) min(R s, |u - r0|),   T y' = r - y,
///   tau = y (1 + A sin(N psi)) - b psi' - c tanh(psi' / v)
/// so that the torque at a stage of the integrator is an exact function of the time since u began to act.
/// Nothing allocates but state().
class Actuators {
 public:
  /// What the drives remember.
  struct State {
    struct Drive {
      double u = 0, r = 0, y = 0;  ///< the torque asked for, behind the rate limit, behind the lag
      bool operator==(const Drive&) const = default;
    };
    std::vector<Drive> drives;
    bool settled = false;
    bool operator==(const State&) const = default;
  };

  Actuators(const ActuatorSettings& settings, std::size_t n_u);

  /// A motor's; what it doesn't have is neutral.
  struct Drive {
    double rate, lag, ripple, per_turn, viscous, coulomb, smooth;
    double ramp_time(const State::Drive& at) const;
    double ramp(const State::Drive& from, double s) const;
    double lagged(const State::Drive& from, double s) const;
    double less_friction(double torque, double psid, double factor) const;
  };
  const std::vector<Drive>& drives() const { return drives_; }

  /// Before any command.
  State state() const { return {.drives = std::vector<State::Drive>(drives_.size())}; }

  /// `u` is asked for from now on, n_u. The first one finds the drives settled on it.
  static void take(State& state, std::span<const double> u);

  /// What acts (n_u) `s` seconds after take or pass, whichever came last.
  void torque(const State& state, double s, std::span<const double> psi, std::span<const double> psid,
              double friction, std::span<double> tau) const;

  /// Adds what friction leaves of tau, and gives its slopes d tau_i / d psid_i, n_u each.
  void add_friction(std::span<const double> psid, std::span<double> tau) const;
  void friction_slopes(std::span<const double> psid, std::span<double> slopes) const;

  /// `s` seconds go by.
  void pass(State& state, double s) const;

  /// When, after `s`, a torque next has a kink: a ramp that no lag smooths is over. HUGE_VAL: never.
  double next_kink(const State& state, double s) const;

 private:
  std::vector<Drive> drives_;
};

}  // namespace mixloop
