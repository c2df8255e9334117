// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace mixloop {

/// What is desired at one instant: motors and, in the inertial frame, the end effector. SI, radians.
struct Reference {
  Eigen::VectorXd psi, psid, psidd;                ///< n each
  Eigen::Vector3d position, velocity, acceleration;
};

}  // namespace mixloop
