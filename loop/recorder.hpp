// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "loop/experiment.hpp"
#include "loop/measures.hpp"
#include "loop/orientation_error.hpp"
#include "loop/record_rows.hpp"
#include "notation/sha256.hpp"

namespace mixloop {

/// How what is told of a tick is evaluated where coordinates are switched: a program for each partition is
/// quickly interpreted, and long in compiling; the bits are the same.
inline Evaluation told_by(const Experiment& experiment) {
  return std::min(experiment.evaluation, Evaluation::interpreter);
}

/// What a recorder does beside judging a run.
struct RecorderSettings {
  bool knows_work = true;                     ///< the motors' work is told; else there is no energy drift
  bool keeps_ticks = true;                    ///< else the last two alone, and there is no trajectory_sha256
  std::optional<double> settled_within = {};  ///< m: it tells from when on the position error is so small
};

/// Keeps a run, tick by tick, and judges it. Nothing allocates after construction.
class Recorder {
 public:
  Recorder(const Experiment& experiment, const Plan& plan, const RecorderSettings& settings = {});

  /// What the record takes, all its ticks alike.
  static std::size_t bytes_a_tick(const Experiment& experiment);

  /// Takes the state at tick k and the work done until then. False where the run has diverged: the position
  /// error is past its limit or something is not finite; then the tick is not recorded. Ticks past the plan's
  /// end (a plant that holds on) are watched, and the last two of them kept.
  bool state(std::int64_t k, std::span<const double> psi, std::span<const double> psid, double work);
  /// The same where coordinates are switched, and how often they were until then.
  bool state(std::int64_t k, std::span<const double> psi, std::span<const double> psid, double work,
             const LoopMotion& loops, std::int64_t switches);
  /// What is watched of the closures at a tick.
  void closures(const ClosureWatch& watch);
  /// The mechanism can't go on from tick k, and why: false.
  bool no_way_on(std::int64_t k, std::string why);

  /// Takes the command of tick k, which completes the tick. False where it is not finite.
  bool command(std::int64_t k, std::span<const double> tau, std::span<const double> applied);

  /// Keeps what faults have changed at tick k, if anything; before its command.
  void note_changes(std::int64_t k, const Faults::State& faults);

  void interrupted();
  /// From tick k on the plant is in its safe state: recorded, and judged no more.
  void made_safe(std::int64_t k);

  std::int64_t ticks_recorded() const { return recorded_; }
  std::span<const double> psi(std::int64_t k) const { return {row(k), n_}; }
  std::span<const double> psid(std::int64_t k) const { return {row(k) + n_, n_}; }
  std::span<const double> commanded(std::int64_t k) const { return {row(k) + 2 * n_, n_u_}; }
  std::span<const double> applied(std::int64_t k) const { return {row(k) + 2 * n_ + n_u_, n_u_}; }
  double work(std::int64_t k) const { return row(k)[2 * n_ + 2 * n_u_]; }
  /// How the loops moved at a tick, into what has room for it; of a run that switches coordinates.
  void loops(std::int64_t k, LoopMotion& motion) const;
  double time(std::int64_t k) const { return static_cast<double>(k) / rate_hz_; }
  /// The scene's parameters and the factor on its friction at a tick.
  struct Conditions {
    std::int64_t since = -1;  ///< the tick of the latest change; -1: none
    std::span<const double> parameters;
    double friction = 1;
  };
  Conditions conditions(std::int64_t k) const;
  /// The first tick of the safe state.
  std::int64_t safe_from() const { return safe_from_; }
  double position_error() const { return error_; }  ///< at the latest state, m; 0 without a path

  Measures measures() const;
  const Equations& equations() const { return kinematics_.equations(); }

 private:
  const double* row(std::int64_t k) const {
    const std::int64_t slot = k < kept_ ? k : kept_ + k % 2;
    return rows_.data() + static_cast<std::size_t>(slot) * width();
  }
  double* row(std::int64_t k) { return const_cast<double*>(std::as_const(*this).row(k)); }
  std::size_t width() const { return 2 * n_ + 2 * n_u_ + 1 + loops_; }
  bool judged(std::int64_t k) const { return k < safe_from_; }
  void measure(std::int64_t k, std::span<const double> tau);
  void measure_path(std::int64_t k);
  void measure_energy(std::int64_t k);
  bool motors_are_off(std::int64_t k, std::span<const double> psi);
  std::optional<Vector> final_psi() const;
  bool diverged(std::int64_t k);

  const Plan& plan_;
  Equations::Workspace kinematics_;
  std::vector<int> axes_;
  std::size_t n_, n_u_;
  std::size_t loops_;  ///< numbers of a LoopMotion; 0 where no coordinates are switched
  double rate_hz_, limit_;
  std::int64_t kept_;  ///< ticks; of those past them the last two
  RecordRows rows_;    ///< of each tick: psi, psid (n each), commanded, applied (n_u each), work, loops
  /// Changes kept of injected faults; past them the latest one stands for those before it.
  static constexpr std::size_t kInjectedKept = 1000;
  std::size_t row_of_conditions_ = 0;
  std::vector<double> conditions_;  ///< rows of tick, friction, parameters: as it began, then each change
  std::vector<double> zero_, hand_;
  std::optional<OrientationError> orientation_;  ///< none: nothing is prescribed
  std::vector<double> motor_error_limit_;        ///< of a path of the motors; empty: none
  Vector motor_error_;                           ///< n_u, of a path of the motors
  std::optional<Equations::Workspace> energy_;   ///< none: it isn't measured
  std::optional<Partitions> switched_energy_;    ///< where coordinates are switched
  LoopMotion hand_loops_;
  double first_energy_ = 0, largest_energy_ = 0, largest_imbalance_ = 0;  ///< J
  bool energy_begun_ = false, energy_changed_ = false;                    ///< changed: by a fault
  bool tells_final_ = false;
  std::int64_t recorded_ = 0;
  std::int64_t safe_from_ = std::numeric_limits<std::int64_t>::max();
  std::optional<double> settled_within_;
  double error_ = 0, sum_of_squares_ = 0;
  std::int64_t errors_ = 0;
  Measures measures_;
};

}  // namespace mixloop
