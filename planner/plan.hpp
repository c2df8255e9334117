// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/procedure/model.hpp"
#include "planner/path.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// What a path must respect; an empty list is no limit. One value a motor.
struct PlanLimits {
  std::vector<double> velocity;  ///< rad/s or m/s
  std::vector<double> torque;    ///< N m or N, along the path by inverse dynamics
};

/// The references of a whole experiment, worked out and checked before anything moves.
/// Reference(k) is a table look-up, so a repeated tick has the same bytes.
class Plan {
 public:
  struct Settings {
    double rate_hz = 1000;
    int stages_per_tick = 1;  ///< 2 * substeps for control evaluated at every RK4 stage, else 1
    PlanLimits limits;
    std::vector<double> start_psi;         ///< where the plant stands; empty: at the path's start
    std::optional<double> approach;        ///< duration of the move to the start, s; empty: as fast as `limits.velocity` allows, at least 1 s
  };

  /// Throws InputError (code "unreachable", "singular_path", "crosses_branch", "over_limit", "off_grid") saying
  /// where on the path and why.
  Plan(const Model<double>& model, const Path& path, const Settings& settings);

  std::int64_t ticks() const { return ticks_; }            ///< N: the last tick
  std::int64_t start_tick() const { return start_tick_; }  ///< where the path begins, after a move to the start

  /// At tick k, clamped to [0, N]: past the end the end point is held.
  const Reference& at(std::int64_t k) const;
  /// At stage j of tick k, 0 <= j < stages_per_tick: time (k + j / stages_per_tick) / rate.
  const Reference& at_stage(std::int64_t k, int j) const;

 private:
  std::int64_t ticks_ = 0;
  std::int64_t start_tick_ = 0;
  int stages_ = 1;
  std::vector<Reference> table_;
};

}  // namespace mixloop
