// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/matrix.hpp"

namespace mixloop {

/// A x = b of a few equations without pivots or branches, so that it can be recorded: by cofactors up to
/// four, above by the modified Gram-Schmidt process, applied to b as to a further column, which is as stable
/// as Householder's (Bjoerck, Numerical Methods for Least Squares Problems, 2.4). Not finite where A is
/// singular.
template <class T>
class SmallSystem {
 public:
  static constexpr Eigen::Index kMostByCofactors = 4;

  SmallSystem() = default;
  explicit SmallSystem(const Mat<T>& A) {
    if (A.rows() <= kMostByCofactors)
      invert(A);
    else
      orthogonalise(A);
  }

  Vec<T> solve(Vec<T> b) const {
    if (R_.size() == 0) return inverse_.lazyProduct(b);
    const Eigen::Index k = b.size();
    Vec<T> x(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      x[i] = Q_.col(i).dot(b);
      for (Eigen::Index r = 0; r < k; ++r) b[r] -= x[i] * Q_(r, i);
    }
    for (Eigen::Index i = k; i-- > 0;) {
      for (Eigen::Index j = i + 1; j < k; ++j) x[i] -= R_(i, j) * x[j];
      x[i] = x[i] * R_(i, i);
    }
    return x;
  }

 private:
  /// The determinant of A without some rows and columns.
  static T minor(const Mat<T>& A, unsigned rows, unsigned columns) {
    Eigen::Index first = 0;
    while (first < A.rows() && !(rows >> first & 1)) ++first;
    if (first == A.rows()) return T(1);
    T sum(0);
    bool negative = false;
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      if (!(columns >> j & 1)) continue;
      const T part = A(first, j) * minor(A, rows & ~(1u << first), columns & ~(1u << j));
      sum = negative ? T(sum - part) : T(sum + part);
      negative = !negative;
    }
    return sum;
  }

  void invert(const Mat<T>& A) {
    const Eigen::Index k = A.rows();
    const unsigned all = (1u << k) - 1;
    Mat<T> cofactors(k, k);
    for (Eigen::Index i = 0; i < k; ++i)
      for (Eigen::Index j = 0; j < k; ++j) {
        const T m = minor(A, all & ~(1u << i), all & ~(1u << j));
        cofactors(j, i) = (i + j) % 2 == 0 ? m : T(-m);
      }
    T determinant(0);
    for (Eigen::Index j = 0; j < k; ++j) determinant += A(0, j) * cofactors(j, 0);
    inverse_ = cofactors * T(T(1) / determinant);
  }

  void orthogonalise(const Mat<T>& A) {
    using std::sqrt;
    const Eigen::Index k = A.rows();
    Q_ = A;
    R_ = Mat<T>::Constant(k, k, T(0));  // its diagonal inverted
    for (Eigen::Index i = 0; i < k; ++i) {
      R_(i, i) = T(1) / sqrt(T(Q_.col(i).dot(Q_.col(i))));
      for (Eigen::Index r = 0; r < k; ++r) Q_(r, i) *= R_(i, i);
      for (Eigen::Index j = i + 1; j < k; ++j) {
        R_(i, j) = Q_.col(i).dot(Q_.col(j));
        for (Eigen::Index r = 0; r < k; ++r) Q_(r, j) -= R_(i, j) * Q_(r, i);
      }
    }
  }

  Mat<T> inverse_, Q_, R_;
};

}  // namespace mixloop
