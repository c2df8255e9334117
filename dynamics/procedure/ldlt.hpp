// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// L D L^T of a symmetric positive definite A without pivots or branches (Golub & Van Loan, 4.1.2), so that
/// it can be recorded: L's strict lower triangle and D on the diagonal, in place.
template <class T>
void factor_ldlt(Mat<T>& A) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < j; ++k) A(j, j) -= A(j, k) * A(j, k) * A(k, k);
    for (Eigen::Index i = j + 1; i < n; ++i) {
      for (Eigen::Index k = 0; k < j; ++k) A(i, j) -= A(i, k) * A(j, k) * A(k, k);
      A(i, j) = A(i, j) / A(j, j);
    }
  }
}

/// Solves A x = b in place for a factored A.
template <class T>
void solve_ldlt(const Mat<T>& LD, Vec<T>& b) {
  const Eigen::Index n = LD.rows();
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < i; ++k) b[i] -= LD(i, k) * b[k];
  for (Eigen::Index i = 0; i < n; ++i) b[i] = b[i] / LD(i, i);
  for (Eigen::Index i = n - 1; i >= 0; --i)
    for (Eigen::Index k = i + 1; k < n; ++k) b[i] -= LD(k, i) * b[k];
}

}  // namespace mixloop
