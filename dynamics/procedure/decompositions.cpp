// SPDX-License-Identifier: MIT
#include "dynamics/procedure/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <unsupported/Eigen/MatrixFunctions>

namespace mixloop {

Matrix solved(const Matrix& A, const Matrix& B) { return Eigen::PartialPivLU<Matrix>(A).solve(B); }

Vec<std::complex<double>> eigenvalues(const Matrix& A) {
  return Eigen::EigenSolver<Matrix>(A, false).eigenvalues();
}

Modes modes(const Matrix& A) {
  const Eigen::EigenSolver<Matrix> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Matrix exponential(const Matrix& A) { return A.exp(); }

}  // namespace mixloop
