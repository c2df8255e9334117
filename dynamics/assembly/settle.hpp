// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/assembly/closing.hpp"

namespace mixloop {

/// Where a search for a pose that closes ended.
struct Settled {
  bool closes = false;  ///< to round-off
  double residual = 0;  ///< the largest, in the units of Closing
  int iterations = 0;
};

/// Brings a part's rows to zero by its unknowns, from x: by Newton's method, by the least step where that is
/// not unique, shortened and damped (Levenberg and Marquardt) where it leads away. x is where it ends.
Settled settle(Closing& closing, const Closing::Part& part, Vector& x, const Vector& psi, double t = 0);

/// How far two poses of the unknowns are from each other, angles mod 2 pi.
double apart(const Closing& closing, const Closing::Part& part, const Vector& one, const Vector& other);
/// Brings angles within half a turn of those of `guess`.
void unwind(const Closing& closing, Vector& x, const Vector& guess);

}  // namespace mixloop
