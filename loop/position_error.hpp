// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>

namespace mixloop {

/// |actual - desired| over the axes that a path prescribes, m.
inline double position_error(const Eigen::Vector3d& actual, const Eigen::Vector3d& desired,
                             std::span<const int> axes) {
  double squared = 0;
  for (const int axis : axes) squared += (actual[axis] - desired[axis]) * (actual[axis] - desired[axis]);
  return std::sqrt(squared);
}

}  // namespace mixloop
