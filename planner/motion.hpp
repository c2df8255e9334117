// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"
#include "dynamics/scene/scene.hpp"

namespace mixloop {

/// Where the end effector shall be at one instant.
struct PathPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2
  /// And how its frame is turned there, where the scene's end effector is oriented.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();       ///< rad/s
  Eigen::Vector3d spin_rate = Eigen::Vector3d::Zero();  ///< rad/s^2
};

/// Psi and its rates at one instant: the motors' (n_u), or those of all independent coordinates (n).
struct PsiMotion {
  Vector psi, psid, psidd;
};

/// The motion of all independent coordinates where the motors move so (rates left out are zero) and the free
/// ones rest at home.
PsiMotion with_free_at_home(const Scene& scene, PsiMotion motors);

}  // namespace mixloop
