// SPDX-License-Identifier: MIT
#include "loop/orientation_error.hpp"

#include <algorithm>

#include "planner/orientation.hpp"

namespace mixloop {

OrientationError::OrientationError(std::shared_ptr<const Scene> scene, std::span<const double> parameters)
    : model_(make_model<double>(std::move(scene), parameters)), ws_(model_), desired_(model_.scene->home) {}

Eigen::Matrix3d OrientationError::rotation_at(std::span<const double> psi, double t) {
  coordinates<double>(model_, psi, t, ws_);
  frame_variations(model_, ws_);
  return ws_.frames[static_cast<std::size_t>(model_.scene->end_effector.frame)].T_0.leftCols<3>();
}

double OrientationError::at(std::span<const double> psi, std::span<const double> motors, double t) {
  std::ranges::copy(motors, desired_.begin());
  const Eigen::Matrix3d actual = rotation_at(psi, t), desired = rotation_at(desired_, t);
  const Scene::EndEffector& end_effector = model_.scene->end_effector;
  if (!end_effector.direction) return rotation_vector(desired * actual.transpose()).norm();
  const Eigen::Vector3d axis = axis_of(end_effector);
  const Eigen::Vector3d here = actual * axis, there = desired * axis;
  return mixloop_functions::atan2(here.cross(there).norm(), here.dot(there));
}

}  // namespace mixloop
