// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/scene/continuous_angles.hpp"
#include "planner/plan.hpp"
#include "planner/refusal.hpp"

namespace mixloop {

/// Makes a plan's table, in the order in which what is wrong with a path is best told: whether it can be
/// reached at all, what it passes too near, how fast and strong the motors must be; then the move to its
/// start.
class PlanMaker {
 public:
  PlanMaker(const Model<double>& model, const Path& path, const Plan::Settings& settings);
  void make(Plan& plan);

 private:
  void require_room(double steps) const;
  std::span<double> row(Plan& plan, std::int64_t index) const;
  Follower follower(std::int64_t delay) {
    return ik_ ? Follower(*ik_, itinerary_, delay) : Follower(hand_, itinerary_, delay);
  }
  void write(const Follower::Motion& motion, double t, std::span<double> row);
  void follow(Plan& plan, std::int64_t delay);
  std::string jump(AngleWatch& angles, const Vector& motors, double t) const;
  void follow_within(Plan& plan, std::int64_t step, Follower& follower);
  void check_singularities(Plan& plan, std::int64_t delay);
  void check_limits(Plan& plan, std::int64_t delay);
  std::int64_t approach_ticks(Plan& plan, const Vector& move);
  Vector fastest_on_path(Plan& plan) const;
  void approach(Plan& plan, const Vector& from, std::int64_t ticks);
  void rest_past_the_end(Plan& plan);

  InverseKinematics* ik() { return ik_.get(); }
  HandKinematics& hand() { return ik_ ? ik_->hand() : hand_; }

  const Model<double>& model_;
  HandKinematics hand_;
  Path path_;  ///< with the end effector's rotation at each of its points
  const Plan::Settings& settings_;
  std::int64_t width_;  ///< rows a step
  Itinerary itinerary_;
  std::unique_ptr<InverseKinematics> ik_;  ///< of a path of the end effector
  SingularityMeasures measures_;
  Refusal refusal_;
  bool timed_;        ///< the constraints depend on time: no lap is like the other
  bool timed_loads_;  ///< there are torque limits, and loads that depend on time
  std::int64_t lap_steps_ = 0;
  std::vector<double> samples_;  ///< measures at each step of the path
};

}  // namespace mixloop
