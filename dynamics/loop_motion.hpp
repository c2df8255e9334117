// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// How a mechanism's loops move, whichever of their coordinates are independent: a value. `at` (rad or m) and
/// `rate` are of the coordinates that are solved for as declared, then of psi (n).
struct LoopMotion {
  int partition = 0;  ///< the one in use
  Vector at, rate;

  bool operator==(const LoopMotion&) const = default;
};

}  // namespace mixloop
