// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/tracer.hpp"

#include "dynamics/procedure/ldlt.hpp"

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
  for (std::size_t i = 0; i < scene.parameters.size(); ++i)
    parameters.push_back(input(Block::parameter, static_cast<int>(i)));
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

ExpressionMatrix Tracer::mass_inverse_times(const ExpressionMatrix& B) {
  ExpressionMatrix L = mass_matrix();
  factor_ldlt(L);
  ExpressionMatrix X = B;
  for (Eigen::Index j = 0; j < B.cols(); ++j) {
    ExpressionVector column = B.col(j);
    solve_ldlt(L, column);
    X.col(j) = column;
  }
  return X;
}

}  // namespace mixloop
