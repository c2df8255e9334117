// SPDX-License-Identifier: MIT
#pragma once

#include "planner/follower.hpp"
#include "planner/limits.hpp"
#include "planner/singularity.hpp"

namespace mixloop {

/// Says why a path is refused, and where on it: each function throws its InputError.
class Refusal {
 public:
  /// `ik`: of a path of the end effector; null of one of the motors.
  Refusal(const Path& path, const Itinerary& itinerary, InverseKinematics* ik, SingularityMeasures& measures)
      : path_(path), itinerary_(itinerary), ik_(ik), measures_(measures) {}

  /// The search for the path's start failed at plant time t, nearest to it at `nearest`.
  [[noreturn]] void no_start(IkOutcome outcome, const Vector& nearest, double t) const;
  /// The follower failed on its way to `step`: where the way ends, and how far out of reach the path goes
  /// from there, or which singularity it ends in.
  [[noreturn]] void no_way(Follower& follower, double step) const;
  /// `lost`: what the end effector can't do there.
  [[noreturn]] void passage(const Passage& passage, const std::string& lost = {}) const;
  [[noreturn]] void excess(const Excess& excess) const;
  /// A coordinate jumps, as AngleWatch says.
  [[noreturn]] void jump(double step, const std::string& jumped) const;
  /// The same on the move to the start.
  [[noreturn]] void jump_before(double step, const std::string& jumped, double duration) const;
  [[noreturn]] void passage_before(const Passage& passage, double duration) const;
  [[noreturn]] void not_closed_before(double step, double duration) const;
  [[noreturn]] void excess_before(const Excess& excess, double duration) const;

 private:
  [[noreturn]] void singular(double step, const Vector& last, double t) const;
  [[noreturn]] void not_closed(double step) const;
  double out_of_reach(double step, double t, Vector nearby) const;
  std::string reach_text(double step, double t, Vector nearby) const;
  std::string text(const Passage& passage) const;
  std::string where(double step) const;
  std::string where_before(double step, double duration) const;

  const Path& path_;
  const Itinerary& itinerary_;
  InverseKinematics* ik_;
  SingularityMeasures& measures_;
};

}  // namespace mixloop
