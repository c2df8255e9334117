// SPDX-License-Identifier: MIT
#pragma once

#include "planner/inverse_kinematics.hpp"
#include "planner/itinerary.hpp"

namespace mixloop {

/// The motors along an itinerary, step by step, each solution the continuation of the one before.
class Follower {
 public:
  /// Along a path of the end effector. `delay`: plant time at which the path starts, in steps. Refers to
  /// both.
  Follower(InverseKinematics& ik, const Itinerary& itinerary, std::int64_t delay)
      : ik_(&ik), itinerary_(itinerary), delay_(static_cast<double>(delay)) {}
  /// Along one of the motors.
  Follower(HandKinematics& hand, const Itinerary& itinerary, std::int64_t delay)
      : hand_(&hand), itinerary_(itinerary), delay_(static_cast<double>(delay)) {}

  /// A place on the path and the motors' motion there.
  struct Motion {
    double step = 0;
    PathPoint desired;
    PsiMotion motors;
  };

  /// At the path's start, on the branch of home.
  IkOutcome start(const InverseKinematics::Accepts& accepts);
  /// On to `step` from the motion in hand; without a solution there, the motion in hand is a last one before
  /// it.
  IkOutcome advance(double step);
  /// Takes up the path at a motion known from before.
  void resume(Motion motion) { now_ = std::move(motion); }

  const Motion& now() const { return now_; }
  double time(double step) const { return (delay_ + step) / itinerary_.step_rate(); }
  /// After a failure: the first step, between `now` and the one that failed, to which there is no way.
  double limit(double failed);

 private:
  IkOutcome follow_motors(double step);
  IkOutcome try_advance(double step, int halvings);
  Vector expected(double step);
  IkOutcome complete(double step, const PathPoint& desired, Vector psi);

  InverseKinematics* ik_ = nullptr;  ///< one of the two
  HandKinematics* hand_ = nullptr;
  const Itinerary& itinerary_;
  double delay_;
  Motion now_;
};

}  // namespace mixloop
