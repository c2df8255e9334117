// SPDX-License-Identifier: MIT
#pragma once

#include "planner/limits.hpp"
#include "planner/motion.hpp"

namespace mixloop {

/// A move of the motors from rest to a given motion at its end, of fifth degree in time.
class MoveToStart {
 public:
  /// `duration` in s.
  MoveToStart(const Vector& from, const PsiMotion& to, double duration);

  double duration() const { return duration_; }
  /// At x = t / duration in [0, 1].
  PsiMotion at(double x) const;

 private:
  Vector from_, c3_, c4_, c5_;
  double duration_;
};

/// The shortest duration, but at least 1 s, in which no motor is faster than `fastest` says (rad/s or m/s; 0:
/// that it doesn't say) when moving by `move` from rest to rest.
double shortest_move(const Vector& move, const Vector& fastest);

}  // namespace mixloop
