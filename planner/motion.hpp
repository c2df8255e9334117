// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// Where the end effector shall be at one instant.
struct PathPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2
};

/// The motors at one instant, n each.
struct MotorMotion {
  Vector psi, psid, psidd;
};

}  // namespace mixloop
