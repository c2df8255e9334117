// SPDX-License-Identifier: MIT
#pragma once

#include "controller/feedback.hpp"
#include "loop/experiment.hpp"

namespace mixloop {

/// Plant and controller linearised about a reference, x = (d psi, d psid), 2n:
///   x' = A x + B u,  u = (feedback) x,
/// frozen there: the reference's own motion is left out.
struct LinearLoop {
  Matrix A;  ///< 2n x 2n
  Matrix B;  ///< 2n x n_u
  Feedback feedback;
};

/// A plant alone, linearised where it is with the motors' torques that go with that.
struct LinearPlant {
  double t = 0;        ///< s
  PsiMotion at;        ///< n
  Vector torque;       ///< n_u, what keeps the motors so
  Vector free_torque;  ///< n - n_u, what would have to act on the free coordinates; 0 where they stay by
                       ///< themselves
  Matrix A, B;         ///< 2n x 2n, 2n x n_u
};

/// Makes them, from the exact derivatives of the equations of motion.
class Linearisation {
 public:
  explicit Linearisation(const Experiment& experiment);

  const Equations& equations() const { return plant_.equations(); }
  /// At a reference that the plant follows exactly, its free coordinates where wanted_state has them.
  LinearLoop at(const Reference& reference, double t);
  /// Throws RunFault("singular") where the mass matrix is.
  LinearPlant plant_at(const PsiMotion& at, double t);

 private:
  const std::shared_ptr<const Scene> scene_;
  const std::vector<double> parameters_;
  const ControllerSettings settings_;
  const std::vector<int> of_model_;  ///< model_coordinates
  Equations::Workspace plant_, model_;
};

}  // namespace mixloop
