// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/procedure/procedure.hpp"
#include "planner/reference.hpp"

namespace mixloop {

/// What a path must respect; an empty list is no limit. One value a motor.
struct PlanLimits {
  std::vector<double> velocity = {};  ///< rad/s or m/s
  std::vector<double> torque = {};    ///< N m or N, along the path by inverse dynamics of the plan's model,
                                      ///< free coordinates held at home
  std::vector<std::array<double, 2>> position = {};  ///< rad or m, the least and the most
  std::vector<double> motor_error = {};  ///< rad or m, of a path of the motors: past it a run has diverged
};

/// The worst excess over a limit.
struct Excess {
  std::int64_t step = 0;
  double ratio = 1;     ///< of the value to its limit; of a position 1 and its excess over the range
  std::string message;  ///< "motor psi2 would turn at 120 rad/s; its limit is 100 rad/s"
};

/// Looks at references one by one and keeps the worst excess. Of two in a row the mean velocity between them
/// counts too: a motor that has to jump from tick to tick is too fast, however slow it is at both.
class LimitCheck {
 public:
  /// Throws InputError("wrong_size") or ("out_of_range") for limits that don't fit the model.
  LimitCheck(const Model<double>& model, const PlanLimits& limits);

  /// `step` and its time t, s.
  void look(std::int64_t step, const Reference& reference, double t);
  const std::optional<Excess>& worst() const { return worst_; }

 private:
  void compare_position(std::int64_t step, std::size_t motor, double value);
  void compare(std::int64_t step, std::size_t motor, double value, double limit, bool torque);

  const Model<double>& model_;
  const PlanLimits& limits_;
  Workspace<double> ws_;
  std::int64_t last_step_ = -2;
  double last_t_ = 0;
  Vector last_psi_;  ///< n_u
  std::optional<Excess> worst_;
};

}  // namespace mixloop
