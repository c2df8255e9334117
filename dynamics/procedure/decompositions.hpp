// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/LU>
#include <complex>

#include "dynamics/procedure/matrix.hpp"

/// What Eigen's products and decompositions of dense matrices of any size give, compiled once: each takes a
/// compiler ten seconds.
namespace mixloop {

Matrix product(const Matrix& A, const Matrix& B);

/// A^-1 B, A n x n, by LU with partial pivoting; not finite where A is singular.
Matrix solved(const Matrix& A, const Matrix& B);

/// The same of one A and many B.
class Factored {
 public:
  explicit Factored(const Matrix& A);
  Vector solve(const Vector& b) const;
  double determinant() const;

 private:
  Eigen::PartialPivLU<Matrix> lu_;
};

/// A = U diag(s) V^T, s descending, for any A (thin: as many columns as the shorter side).
struct SingularValues {
  Matrix U, V;
  Vector s;

  /// How many are above 1e-9 of the largest.
  int rank() const;
  /// The x of least length that A x misses b least with; values below `cut` of the largest count as none,
  /// others as (s^2 + damping^2) / s.
  Vector solve(const Vector& b, double cut, double damping) const;
};
SingularValues singular_values(const Matrix& A);

/// The eigenvalues of a real n x n matrix, by its real Schur form.
Vec<std::complex<double>> eigenvalues(const Matrix& A);

/// The same with an eigenvector each, of length 1, in the columns; those of a defective matrix are nearly
/// parallel.
struct Modes {
  Vec<std::complex<double>> values;
  Mat<std::complex<double>> vectors;
};
Modes modes(const Matrix& A);

/// e^A, by scaling and squaring (Higham 2005).
Matrix exponential(const Matrix& A);

}  // namespace mixloop
