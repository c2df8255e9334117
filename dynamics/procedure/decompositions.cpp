// SPDX-License-Identifier: MIT
#include "dynamics/procedure/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace mixloop {

Matrix product(const Matrix& A, const Matrix& B) { return A * B; }

Matrix solved(const Matrix& A, const Matrix& B) { return Eigen::PartialPivLU<Matrix>(A).solve(B); }

Factored::Factored(const Matrix& A) : lu_(A) {}
Vector Factored::solve(const Vector& b) const { return lu_.solve(b); }
double Factored::determinant() const { return lu_.determinant(); }

int SingularValues::rank() const {
  int rank = 0;
  while (rank < s.size() && s[rank] > 1e-9 * s[0]) ++rank;
  return rank;
}

Vector SingularValues::solve(const Vector& b, double cut, double damping) const {
  Vector along = U.transpose() * b;
  for (Eigen::Index i = 0; i < s.size(); ++i)
    along[i] = s[i] > cut * s[0] ? along[i] * s[i] / (s[i] * s[i] + damping * damping) : 0.0;
  return V * along;
}

SingularValues singular_values(const Matrix& A) {
  const Eigen::JacobiSVD<Matrix> found(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {found.matrixU(), found.matrixV(), found.singularValues()};
}

Vec<std::complex<double>> eigenvalues(const Matrix& A) {
  return Eigen::EigenSolver<Matrix>(A, false).eigenvalues();
}

Modes modes(const Matrix& A) {
  const Eigen::EigenSolver<Matrix> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Matrix exponential(const Matrix& A) { return A.exp(); }

}  // namespace mixloop
