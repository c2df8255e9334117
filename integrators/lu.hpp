// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// L U = P A in place, with partial pivoting (Golub & Van Loan, 3.4.1); `rows` takes the row that each step
/// chose.
template <class T>
void factor_lu(Mat<T>& A, std::vector<int>& rows) {
  using std::abs;
  const int n = static_cast<int>(A.rows());
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (abs(A(i, k)) > abs(A(best, k))) best = i;
    rows[static_cast<std::size_t>(k)] = best;
    if (best != k)
      for (int j = 0; j < n; ++j) std::swap(A(k, j), A(best, j));
    const T inverse = T(1) / A(k, k);
    for (int i = k + 1; i < n; ++i) {
      A(i, k) *= inverse;
      for (int j = k + 1; j < n; ++j) A(i, j) -= A(i, k) * A(k, j);
    }
  }
}

/// A^-1 b in place, A as factor_lu left it.
template <class T>
void solve_lu(const Mat<T>& A, const std::vector<int>& rows, Vec<T>& b) {
  const int n = static_cast<int>(A.rows());
  for (int k = 0; k < n; ++k) std::swap(b[k], b[rows[static_cast<std::size_t>(k)]]);
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) b[i] -= A(i, j) * b[j];
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) b[i] -= A(i, j) * b[j];
    b[i] /= A(i, i);
  }
}

}  // namespace mixloop
