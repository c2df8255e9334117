// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "import/robot.hpp"

namespace mixloop {

/// Rz(yaw) Ry(pitch) Rx(roll) of (roll, pitch, yaw), exact at right angles.
Eigen::Matrix3d rotation_of(const Triple& rpy);

inline Eigen::Vector3d vector_of(const Triple& triple) { return {triple[0], triple[1], triple[2]}; }

}  // namespace mixloop
