// SPDX-License-Identifier: MIT
#include "planner/move_to_start.hpp"

#include <algorithm>
#include <cmath>

namespace mixloop {

// psi = from + c3 x^3 + c4 x^4 + c5 x^5 with psi, psi' and psi'' given at x = 1.
MoveToStart::MoveToStart(const Vector& from, const PsiMotion& to, double duration)
    : from_(from), duration_(duration) {
  const Vector move = to.psi - from, V = duration * to.psid, A = duration * duration * to.psidd;
  c3_ = 10 * move - 4 * V + A / 2;
  c4_ = -15 * move + 7 * V - A;
  c5_ = 6 * move - 3 * V + A / 2;
}

PsiMotion MoveToStart::at(double x) const {
  return {from_ + x * x * x * (c3_ + x * (c4_ + x * c5_)),
          x * x * (3 * c3_ + x * (4 * c4_ + x * 5 * c5_)) / duration_,
          x * (6 * c3_ + x * (12 * c4_ + x * 20 * c5_)) / (duration_ * duration_)};
}

double shortest_move(const Vector& move, const Vector& fastest) {
  constexpr double kPeak = 15.0 / 8;  // of the rate over its mean, at x = 1/2
  double duration = 1;
  for (Eigen::Index i = 0; i < move.size(); ++i)
    if (fastest[i] > 0) duration = std::max(duration, kPeak * std::abs(move[i]) / fastest[i]);
  return duration;
}

}  // namespace mixloop
