// SPDX-License-Identifier: MIT
#include "plant/held_motors.hpp"

#include "dynamics/procedure/ldlt.hpp"

namespace mixloop {

HeldMotors::HeldMotors(Eigen::Index n, Eigen::Index n_u)
    : n_u_(n_u), M_(n, n), factored_(n - n_u, n - n_u), free_(n - n_u), change_(n), torque_(n_u) {}

void HeldMotors::look(Equations::Workspace& dynamics, std::span<const double> psi, double t) {
  dynamics.evaluate(Purpose::mass_matrix, {.psi = psi, .t = t},
                    {M_.data(), static_cast<std::size_t>(M_.size())});
  factored_ = M_.bottomRightCorner(free_.size(), free_.size());
  factor_ldlt(factored_);
}

// x_f + M_ff^-1 M_fm x_m
void HeldMotors::hold(Eigen::Ref<Matrix> x) {
  const Eigen::Index n_f = free_.size();
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    free_.noalias() = M_.bottomLeftCorner(n_f, n_u_) * x.col(j).head(n_u_);
    solve_ldlt(factored_, free_);
    x.col(j).tail(n_f) += free_;
    x.col(j).head(n_u_).setZero();
  }
}

// tau = M (psi'' - a), of the motors
const Vector& HeldMotors::torque(const Eigen::Ref<const Vector>& a) {
  change_ = a;
  hold(change_);
  change_ -= a;
  torque_.noalias() = M_.topRows(n_u_) * change_;
  return torque_;
}

}  // namespace mixloop
