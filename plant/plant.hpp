// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "dynamics/equations.hpp"
#include "dynamics/equations_shelf.hpp"
#include "dynamics/partitions.hpp"
#include "plant/hardware.hpp"
#include "plant/held_motors.hpp"
#include "plant/ideal_plant.hpp"

namespace mixloop {

/// The equations that a plant of these settings evaluates, at first; from a shelf where there is one.
std::shared_ptr<const Equations> plant_equations(std::shared_ptr<const Scene> scene, Evaluation how,
                                                 const PlantSettings& settings,
                                                 EquationsShelf* shelf = nullptr);

/// The simulated hardware: constraint-reduced forward dynamics, a torque held from command to command (or
/// continuous), dead time and saturation; drives, sensors and faults where settings ask for them. It knows
/// ticks, no clock. Nothing allocates after construction.
class Plant {
 public:
  /// It starts at psi0 (n) with the rates psid0 (n); none: at rest.
  Plant(Equations::Workspace dynamics, const PlantSettings& settings, double rate_hz,
        std::span<const double> psi0, std::span<const double> psid0 = {});

  /// All that it remembers.
  const PlantState& state() const { return state_; }
  /// Goes on from a state of this plant, or of one that is built like it.
  void put_back(const PlantState& state);

  std::int64_t tick() const { return state_.motion.tick; }
  double time() const { return model().time(tick()); }  ///< t_k = k / rate
  /// As declared, whichever coordinates are in use: at tick(), or where none are switched where take_effect
  /// left it.
  std::span<const double> psi() const {
    return is_switched() ? partitions_->psi(state_.loops) : state_.motion.psi();
  }
  std::span<const double> psid() const {
    return is_switched() ? partitions_->psid(state_.loops) : state_.motion.psid();
  }
  /// The work that the motors have done, J: the integral of tau . psi' over them.
  double work() const { return state_.motion.work(); }
  /// What acts from time() on (n_u), after delay, saturation and what the drives make of it, N m or N.
  std::span<const double> applied() const { return span_of(state_.motion.applied); }

  /// What the sensors say at tick() of what they measure; true where a reading is older than it should be.
  bool measure(std::span<double> psi, std::span<double> psid);
  /// Which of the independent coordinates are measured, the motors first.
  std::span<const int> measured() const { return measured_; }
  /// Whether that is psi() and psid().
  bool measures_exactly() const {
    return (!hardware_ || !hardware_->sensors) && measured_.size() == psi().size();
  }
  /// Takes a fault, which acts from tick() on or later. False: it can't be (objection says why), too many
  /// wait for their time, or the settings don't allow any.
  bool inject(const Fault& fault);
  /// Of faults that come now, as Faults says: what plants without any can't have.
  bool heals_at_once(const Fault& fault) const {
    return faults() && hardware_->faults->heals_at_once(fault, tick());
  }
  bool is_wrong(const Fault& fault) const {
    return faults() && hardware_->faults->is_wrong(*faults(), fault);
  }
  bool no_more_may_wait(std::size_t beside) const {
    return !faults() || hardware_->faults->full(*faults(), beside);
  }
  /// Null where nothing can go wrong.
  const Faults::State* faults() const {
    return hardware_ && hardware_->faults ? &state_.hardware.faults : nullptr;
  }

  /// Takes COMMAND(tick()); it acts from t_k + command_delay on.
  void command(std::span<const double> tau);

  /// Goes on to the next tick, the commands held.
  void advance();

  /// Goes on within the tick to `offset` s after its start; from there on `tau` acts, at once: a real-time
  /// command's arrival. Offsets of a tick don't fall; those before what is reached act there.
  void take_effect(double offset, std::span<const double> tau);
  /// Goes on to the next tick from where take_effect left it, or from the tick's start.
  void finish_tick();

  /// The motors lock where they stand, for good: their velocities are zero and their positions stay. What
  /// that absorbs is no work of theirs. Free coordinates move on (HeldMotors).
  void lock();

  /// Goes on to the next tick, `control(row, t, psi, psid, tau)` evaluated at every stage of the method; rows
  /// are those of stage_rows, one substep's after the other's. Of a method with a Jacobian: undefined.
  template <class Control>
  void advance_continuously(const Control& control);

  /// What is watched of the closures at tick(); nothing where no chain closes.
  std::optional<ClosureWatch> closures() const;
  /// Why the mechanism can't go on from tick(): its closures are at a singular pose, or beyond their reach.
  /// Empty where it can.
  std::string no_way_on() const;

  /// How the loops move at tick(), and how often other coordinates were switched to; null and 0 where none
  /// are to be.
  const LoopMotion* loops() const { return partitions_ ? &state_.loops : nullptr; }
  std::int64_t switches() const { return state_.switches; }

  /// Those in use.
  const Equations& equations() const { return ideal_.dynamics().equations(); }
  /// z'' of the coordinates in use, psi'' where none are switched, at the state in hand with `applied()`.
  void acceleration(std::span<double> zdd);

 private:
  struct Drives;
  const PlantModel& model() const { return ideal_.model(); }
  void take(std::span<const double> tau);
  void begin_tick();
  void follow_closures();
  bool is_switched() const { return state_.loops.partition > 0; }
  const Scene& declared() const { return partitions_ ? partitions_->declared() : equations().scene(); }
  void follow_partitions();
  int best_partition(const ClosureWatch& watch);
  void go_over_to(int partition);
  struct Declared {
    std::span<const double> psi, psid;
  };
  Declared declared_at(double t, const Vector& x);
  void set_parameters(const Faults::State& faults);
  void take_changes();
  void take_by_hardware(std::span<const double> tau);
  void integrate_driven(double t, double length);
  void integrate_held(double t, double length);
  void drive(double s, std::span<const double> psi, std::span<const double> psid);
  void driven_rate_of(double s, double t, const Vector& x, Vector& dx);

  IdealPlant<double, Equations::Workspace> ideal_;
  StageRows rows_;
  bool faults_may_come_;  ///< by inject
  std::vector<int> measured_;
  std::optional<Hardware> hardware_;  ///< none: ideal
  std::optional<HeldMotors> held_;    ///< where there are free coordinates
  Vector held_rates_;                 ///< x' of the locked plant, of methods with a Jacobian
  PlantState state_;
  bool is_closed_ = true;                 ///< closures hold at tick()
  std::optional<Partitions> partitions_;  ///< where coordinates are switched
  LoopMotion stage_;                      ///< at a stage
};

template <class Control>
void Plant::advance_continuously(const Control& control) {
  auto& motion = state_.motion;
  const auto rate = [&](int step, int stage, double after, const Vector& x, Vector& dx) {
    const double t = time() + after;
    const auto [psi, psid] = declared_at(t, x);
    control(rows_.rows * step + rows_.row[static_cast<std::size_t>(stage)], t, psi, psid,
            span_of(motion.applied));
    take(applied());
    hardware_ || is_switched() ? driven_rate_of(0, t, x, dx) : ideal_.rate_of(motion, t, x, dx);
  };
  ideal_.integrator().advance(motion.x, model().tick_length(), rate, [](double, const Vector&, auto&) {});
  ++motion.tick;
  begin_tick();
}

}  // namespace mixloop
