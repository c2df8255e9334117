// SPDX-License-Identifier: MIT
#include "stability/sampled_loop.hpp"

#include <cmath>

#include "dynamics/procedure/decompositions.hpp"

namespace mixloop {
namespace {

double radius_of(const Eigen::VectorXcd& values) { return values.cwiseAbs().maxCoeff(); }

}  // namespace

Held::Held(const Matrix& A, const Matrix& B, double s) {
  const auto rows = A.rows(), columns = B.cols();
  Matrix block = Matrix::Zero(rows + columns, rows + columns);
  block.topLeftCorner(rows, rows) = A * s;
  block.topRightCorner(rows, columns) = B * s;
  const Matrix held = exponential(block);
  Phi = held.topLeftCorner(rows, rows);
  Gamma = held.topRightCorner(rows, columns);
}

Matrix sampled_transition(const LinearLoop& loop, const Matrix& gain, const Sampling& sampling) {
  const auto states = loop.A.rows(), n_u = loop.B.cols();
  // A delay within a billionth of whole ticks is whole, as the plant has it.
  const auto d = static_cast<Eigen::Index>(std::floor(sampling.delay / sampling.tick + 1e-9));
  const double rest = std::max(0.0, sampling.delay - static_cast<double>(d) * sampling.tick);
  const Held after(loop.A, loop.B, sampling.tick - rest), before(loop.A, loop.B, rest);

  Matrix next = Matrix::Zero(states + n_u * (d + 1), states + n_u * (d + 1));
  next.topLeftCorner(states, states) = product(after.Phi, before.Phi);
  next.block(0, states + n_u * d, states, n_u) = product(after.Phi, before.Gamma);  // u_{k-d-1}
  if (d == 0)
    next.topLeftCorner(states, states) += product(after.Gamma, gain);  // u_k = gain x_k
  else
    next.block(0, states + n_u * (d - 1), states, n_u) = after.Gamma;  // u_{k-d}
  next.block(states, 0, n_u, states) = gain;
  next.block(states + n_u, states, n_u * d, n_u * d).setIdentity();
  return next;
}

double sampled_radius(const LinearLoop& loop, const Matrix& gain, const Sampling& sampling) {
  const Matrix next = sampled_transition(loop, gain, sampling);
  if (!next.allFinite()) return HUGE_VAL;
  return radius_of(eigenvalues(next));
}

Eigen::VectorXcd poles(const LinearLoop& loop, const Matrix& gain) {
  return eigenvalues(loop.A + product(loop.B, gain));
}

double rk4_radius(const Eigen::VectorXcd& poles, double h) {
  return radius_of(poles.unaryExpr([h](std::complex<double> pole) {
    const std::complex<double> z = h * pole;
    return 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
  }));
}

}  // namespace mixloop
