// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/equations.hpp"
#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// How free coordinates move on while the motors are held where they stand.
///
/// Of M a + h = 0 and M psi'' + h = tau with psi''_m = 0 the free rows give psi''_f = a_f + M_ff^-1 M_fm a_m,
/// which is -M_ff^-1 h_f. What stops the motors at once is an impulse on them alone, and does the same to the
/// rates. Nothing allocates after construction.
class HeldMotors {
 public:
  HeldMotors(Eigen::Index n, Eigen::Index n_u);

  /// Takes M where psi (n) is. `dynamics` serves mass_matrix.
  void look(Equations::Workspace& dynamics, std::span<const double> psi, double t);
  /// Makes of accelerations without torque, of their slopes, or of rates (n rows) those of held motors, whose
  /// own are 0.
  void hold(Eigen::Ref<Matrix> x);
  /// The torque (n_u) that holds the motors where without any the accelerations (n) are `a`.
  const Vector& torque(const Eigen::Ref<const Vector>& a);

 private:
  Eigen::Index n_u_;
  Matrix M_, factored_;  ///< n x n; M_ff as factor_ldlt leaves it
  Vector free_, change_, torque_;
};

}  // namespace mixloop
