// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace mixloop {

/// What a controller gets to see of the robot. SI, radians; a view: who makes one keeps the numbers.
struct Measurement {
  std::span<const double> psi, psid;  ///< of the independent coordinates those measured, the motors' first
  double t = 0;                       ///< s, of plant time
  bool stale = false;                 ///< the sensors did not deliver: the values are older than that
};

}  // namespace mixloop
