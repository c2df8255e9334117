// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/assembly/closing.hpp"

namespace mixloop {

/// Which rows determine the unknowns, and in which blocks.
struct Structure {
  std::vector<Closing::Part> blocks;  ///< each after those it needs, as many rows as unknowns
  std::vector<int> redundant;         ///< rows that follow from the others
};

/// A pose that closes, and the motors' there.
struct ClosedPose {
  Vector x, psi;
};

/// Looks at the slopes where the mechanism is closed: at home, x, and at poses nearby, drawn by a seed.
/// Throws InputError("underconstrained") or ("singular_home").
Structure structure_of(Closing& closing, const Vector& x);

/// Closed poses about home, by small moves of the motors; fewer where they close nowhere.
std::vector<ClosedPose> poses_about(Closing& closing, const Vector& x, int count);

/// Of all rows those that are independent at a pose, in their order.
std::vector<int> independent_rows(const Matrix& slopes);

}  // namespace mixloop
