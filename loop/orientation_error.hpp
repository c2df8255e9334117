// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/procedure.hpp"

namespace mixloop {

/// How far an end effector is turned away from where the motors' references would turn it, free coordinates
/// at home; of one with a direction, how far that points elsewhere. Nothing allocates after construction.
class OrientationError {
 public:
  /// `parameters`: the plant's.
  OrientationError(std::shared_ptr<const Scene> scene, std::span<const double> parameters);

  /// rad, at psi (n) and the motors' references (n_u).
  double at(std::span<const double> psi, std::span<const double> motors, double t);

 private:
  Eigen::Matrix3d rotation_at(std::span<const double> psi, double t);

  Model<double> model_;
  Workspace<double> ws_;
  std::vector<double> desired_;
};

}  // namespace mixloop
