// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/procedure/model.hpp"
#include "planner/limits.hpp"
#include "planner/motion.hpp"
#include "planner/path.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// The references of a whole experiment, worked out and checked before anything moves: a move of the motors
/// to the path's start where they don't stand there already, then the path. Reference k is a look-up in a
/// table, so a repeated tick has the same bytes.
class Plan {
 public:
  struct Settings {
    double rate_hz = 1000;
    int stages_per_tick = 1;  ///< equal steps of the table a tick
    std::vector<double> within = {
        0};  ///< rows a step, as shares of it, ascending from 0: an integrator's stages
    PlanLimits limits = {};
    std::vector<double> start_psi = {};  ///< n_u, where the motors stand; empty: at the path's start
  };

  /// Throws InputError saying where on the path and why: "unreachable", "singular_path", "crosses_branch",
  /// "over_limit", "off_grid"; "no_inverse" when the scene has not as many motors as end effector axes;
  /// "too_large" when the table would take more than 1 GB.
  ///
  /// The move to the start takes `path.approach`; without one, at least 1 s and as long as `limits.velocity`
  /// asks for, or, without limits, so long that no motor turns faster than on the path.
  Plan(const Model<double>& model, const Path& path, const Settings& settings);
  /// Of a motion without a path: so many ticks, and at all of them the motors' same reference (n_u), what an
  /// end effector has in it not a number.
  static Plan without_path(const PsiMotion& motors, std::int64_t ticks);

  bool has_path() const { return has_path_; }

  int n_u() const { return n_u_; }
  std::int64_t ticks() const { return ticks_; }  ///< N: the last tick
  /// Where the path begins, after the move to its start.
  std::int64_t start_tick() const { return start_tick_; }

  /// At tick k: time k / rate. Before 0 as at 0; past N the last position with rates of zero.
  /// Valid while the plan lives.
  Reference at(std::int64_t k) const { return at_stage(k, 0); }
  /// At row j of tick k, 0 <= j < stages_per_tick * within.size(), those of a step next to each other: time
  /// (k + (step + within[row]) / stages_per_tick) / rate.
  Reference at_stage(std::int64_t k, int j) const;

 private:
  friend class PlanMaker;
  Plan() = default;
  std::span<const double> row_of(std::int64_t index) const;

  bool has_path_ = true;
  int n_u_ = 0;
  int stages_ = 1;  ///< rows a tick
  std::int64_t ticks_ = 0, start_tick_ = 0;
  std::int64_t lap_rows_ = 0;  ///< of the path's rows in the table: a path that repeats has one lap there
  std::vector<double> table_;  ///< rows of the move to the start, of a lap, of the end, and of rest past it
};

}  // namespace mixloop
