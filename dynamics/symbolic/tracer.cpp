// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/tracer.hpp"

#include <stdexcept>

namespace mixloop {

TracedInputs::TracedInputs(const Scene& scene) : psi(scene.n()), psid(scene.n()) {
  const auto input = [](Block block, int index) {
    return Expression::input(block, static_cast<std::size_t>(index));
  };
  for (int i = 0; i < scene.n(); ++i) {
    psi[i] = input(Block::psi, i);
    psid[i] = input(Block::psid, i);
  }
  t = input(Block::time, 0);
  const std::size_t count = scene.parameters.size() + (scene.friction_factor ? 1 : 0);
  for (std::size_t i = 0; i < count; ++i) parameters.push_back(Expression::input(Block::parameter, i));
}

ExpressionVector motor_inputs(const Scene& scene, int from) {
  ExpressionVector result = ExpressionVector::Constant(scene.n(), Expression(0.0));
  for (int i = 0; i < scene.n_u(); ++i)
    result[i] = Expression::input(Block::input, static_cast<std::size_t>(from + i));
  return result;
}

ExpressionVector Tracer::slopes(int) {
  throw std::logic_error("a force along a coordinate, by a tracer that doesn't know its slopes");
}

ExpressionVector Tracer::mass_times(const ExpressionVector& a) { return mass_matrix().lazyProduct(a); }

ExpressionVector Tracer::inverse_dynamics(const ExpressionVector& psidd) {
  const ExpressionVector inertial = mass_times(psidd);
  return inertial + bias();
}

ExpressionVector Tracer::forward_dynamics(const ExpressionVector& tau) {
  const ExpressionVector h = bias();
  return mass_inverse_times(tau - h);
}

namespace {

// M = L D L^T (Golub & Van Loan, 4.1.2) with one division a column, and Y = L D kept for the next columns.
struct Factors {
  ExpressionMatrix L, Y;
  ExpressionVector inverse_D;

  explicit Factors(const ExpressionMatrix& M) : L(M), Y(M), inverse_D(M.rows()) {
    for (Eigen::Index j = 0; j < M.rows(); ++j) {
      for (Eigen::Index i = j; i < M.rows(); ++i)
        for (Eigen::Index k = 0; k < j; ++k) Y(i, j) -= L(j, k) * Y(i, k);
      inverse_D[j] = Expression(1.0) / Y(j, j);
      for (Eigen::Index i = j + 1; i < M.rows(); ++i) L(i, j) = Y(i, j) * inverse_D[j];
    }
  }

  void solve(ExpressionVector& b) const {
    const Eigen::Index n = b.size();
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < i; ++k) b[i] -= L(i, k) * b[k];
    for (Eigen::Index i = n; i-- > 0;) {
      b[i] = b[i] * inverse_D[i];
      for (Eigen::Index k = i + 1; k < n; ++k) b[i] -= L(k, i) * b[k];
    }
  }
};

}  // namespace

ExpressionMatrix Tracer::mass_inverse_times(const ExpressionMatrix& B) {
  const Factors factors(mass_matrix());
  ExpressionMatrix X = B;
  for (Eigen::Index j = 0; j < B.cols(); ++j) {
    ExpressionVector column = B.col(j);
    factors.solve(column);
    X.col(j) = column;
  }
  return X;
}

}  // namespace mixloop
