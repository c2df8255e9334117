// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "import/left_behind.hpp"
#include "import/robot.hpp"

namespace mixloop {

/// kg m^2, about the centre of mass, in the axes of the link's frame: R I R^T.
Eigen::Matrix3d inertia_in_link(const Robot::Inertial& inertial);

/// Throws InputError at the element: "negative_mass"; "impossible_inertia" where a principal moment is
/// negative or, unless `any`, exceeds the sum of the others by more than rounding (then it is listed);
/// "massless_link" for a link that a joint moves where neither it nor what is fixed to it has mass.
void check_inertias(const Robot& robot, bool any, LeftBehind& left);

/// Of each link, whether a joint moves it.
std::vector<bool> moved_links(const Robot& robot);

}  // namespace mixloop
