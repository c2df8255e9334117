// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/equations.hpp"
#include "integrators/integrator.hpp"
#include "plant/plant_settings.hpp"

namespace mixloop {

class Hardware;

/// The equations that a plant of these settings evaluates.
std::shared_ptr<const Equations> plant_equations(std::shared_ptr<const Scene> scene, Evaluation how,
                                                 const PlantSettings& settings);

/// The simulated hardware: constraint-reduced forward dynamics, a torque held from command to command (or
/// continuous), dead time and saturation; drives, sensors and faults where settings ask for them. It knows
/// ticks, no clock.
class Plant {
 public:
  Plant(Equations::Workspace dynamics, PlantSettings settings, double rate_hz, std::span<const double> psi0);
  ~Plant();
  Plant(Plant&&) noexcept;

  std::int64_t tick() const { return tick_; }
  double time() const { return static_cast<double>(tick_) / rate_hz_; }  ///< t_k = k / rate
  std::span<const double> psi() const { return {x_.data(), n_}; }
  std::span<const double> psid() const { return {x_.data() + n_, n_}; }
  /// The work that the motors have done, J: the integral of tau . psi'.
  double work() const { return x_[static_cast<Eigen::Index>(2 * n_)]; }
  /// What acts from time() on, after delay, saturation and what the drives make of it, N m or N.
  std::span<const double> applied() const { return {applied_.data(), n_}; }

  /// What the sensors say at tick(), n each; true where a reading is older than it should be.
  bool measure(std::span<double> psi, std::span<double> psid);
  /// Whether that is psi() and psid().
  bool measures_exactly() const;
  /// Takes a fault, which acts from tick() on or later. False: it can't be (objection says why), too many
  /// wait for their time, or the settings don't allow any.
  bool inject(const Fault& fault);
  /// Null where nothing can go wrong.
  const Faults* faults() const;

  /// Takes COMMAND(tick()); it acts from t_k + command_delay on.
  void command(std::span<const double> tau);

  /// Goes on to the next tick, the commands held.
  void advance();

  /// Goes on within the tick to `offset` s after its start; from there on `tau` acts, at once: a real-time
  /// command's arrival. Offsets of a tick don't fall; those before what is reached act there.
  void take_effect(double offset, std::span<const double> tau);
  /// Goes on to the next tick from where take_effect left it, or from the tick's start.
  void finish_tick();

  /// The motors lock where they stand, for good: velocities are zero and positions stay. What that absorbs is
  /// no work of theirs.
  void lock();

  /// Goes on to the next tick, `control(row, t, psi, psid, tau)` evaluated at every stage of the method; rows
  /// are those of stage_rows, one substep's after the other's. Of a method with a Jacobian: undefined.
  template <class Control>
  void advance_continuously(const Control& control);

  const Equations& equations() const { return dynamics_.equations(); }
  /// psi'' at the state in hand with `applied()`.
  void acceleration(std::span<double> psidd);

 private:
  void saturate(std::span<const double> tau);
  void integrate_held(double t, double h);
  void integrate_driven(double t, double h);
  void add_work_since_before();
  void saturate_by_hardware(std::span<const double> tau);
  void limit(std::span<const double> tau);
  void begin_tick();
  void begin_hardware_tick();
  void take_changes();
  void drive(double s, std::span<const double> psi, std::span<const double> psid);
  void driven_rate_of(double s, double t, const Vector& x, Vector& dx);
  void rate_of(double t, const Vector& x, Vector& dx);
  void linearise(double t, const Vector& x, AccelerationJacobian<double>& jacobian);
  void time_derivative(double t, const Vector& x, Vector& by_t);

  Equations::Workspace dynamics_;
  PlantSettings settings_;
  double rate_hz_;
  std::size_t n_;
  std::int64_t tick_ = 0;
  std::size_t delay_ticks_ = 0;  ///< whole ticks of the command delay
  double delay_rest_ = 0;        ///< and the rest, s
  bool locked_ = false;
  double within_ = 0;  ///< s after the tick's start that take_effect has reached
  Vector x_;           ///< psi, psid, work
  Vector applied_, before_, scratch_;
  std::vector<Vector> commands_;  ///< a ring by tick, as long as the delay needs
  Integrator integrator_;
  StageRows rows_;
  Vector linearisation_;                ///< 3 n^2, of methods with a Jacobian
  bool timed_;                          ///< the forward dynamics depend on time
  std::unique_ptr<Hardware> hardware_;  ///< null: ideal
};

template <class Control>
void Plant::advance_continuously(const Control& control) {
  const auto rate = [&](int step, int stage, double t, const Vector& x, Vector& dx) {
    const std::span<const double> psi(x.data(), n_), psid(x.data() + n_, n_);
    control(rows_.rows * step + rows_.row[static_cast<std::size_t>(stage)], time() + t, psi, psid,
            span_of(applied_));
    saturate(span_of(std::as_const(applied_)));
    hardware_ ? driven_rate_of(0, time() + t, x, dx) : rate_of(time() + t, x, dx);
  };
  integrator_.advance(x_, 1.0 / rate_hz_, rate, [](double, const Vector&, auto&) {});
  begin_tick();
}

}  // namespace mixloop
