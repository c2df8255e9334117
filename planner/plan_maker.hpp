// SPDX-License-Identifier: MIT
#pragma once

#include "planner/follower.hpp"
#include "planner/plan.hpp"
#include "planner/singularity.hpp"

namespace mixloop {

/// Makes a plan's table, in the order in which what is wrong with a path is best told: whether it can be reached
/// at all, what it passes too near, how fast and strong the motors must be; then the move to its start.
class PlanMaker {
 public:
  PlanMaker(const Model<double>& model, const Path& path, const Plan::Settings& settings);
  void make(Plan& plan);

 private:
  void require_room(std::int64_t steps) const;
  void follow(Plan& plan, std::int64_t delay);
  void check_path(const Plan& plan, std::int64_t delay);
  std::int64_t approach_ticks(const Plan& plan, const Vector& move) const;
  void approach(Plan& plan, const Vector& from, std::int64_t ticks);
  void rest_past_the_end(Plan& plan);
  void write(Plan& plan, std::int64_t row, const Follower::Motion& motion, double t);

  /// How far the point of a step is out of reach, m, 0 within it; and in words. `psi`: motors nearby.
  double out_of_reach(double step, Vector psi);
  std::string reach_text(double step, Vector psi);
  [[noreturn]] void refuse_start(IkOutcome outcome, const Vector& nearest);
  [[noreturn]] void refuse(IkOutcome outcome, Follower& follower, double step);
  [[noreturn]] void refuse_singular(double step, const Vector& last, double t);
  [[noreturn]] void refuse(const Passage& passage, double rate);

  const Model<double>& model_;
  const Path& path_;
  const Plan::Settings& settings_;
  Itinerary itinerary_;
  InverseKinematics ik_;
  SingularityMeasures measures_;
  bool timed_;                   ///< the constraints depend on time: no lap is like the other
  bool timed_loads_;             ///< there are torque limits, and loads that depend on time
  std::vector<double> samples_;  ///< measures at each step of the path
};

}  // namespace mixloop
