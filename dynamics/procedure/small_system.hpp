// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

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

  /// An unknown that stands in two rows and in no other, and the sum of the squares of its two coefficients.
  struct Alone {
    Eigen::Index first, second, unknown;
    T squared;
  };

  SmallSystem() = default;
  explicit SmallSystem(const Mat<T>& A, std::span<const Alone> alone = {}) {
    if (!alone.empty())
      invert_beside(A, alone);
    else if (A.rows() <= kMostByCofactors)
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

  // Rows a x + A_1 y = b_1, b x + A_2 y = b_2 of an unknown x that stands in no other: turned, b A_1 - a A_2
  // is a row of the others', y, alone; and x = (a (b_1 - A_1 y) + b (b_2 - A_2 y)) / (a^2 + b^2).
  void invert_beside(const Mat<T>& A, std::span<const Alone> alone) {
    const Eigen::Index k = A.rows(), others = k - static_cast<Eigen::Index>(alone.size());
    std::vector<bool> row_taken(static_cast<std::size_t>(k)), taken = row_taken;
    Mat<T> turned = Mat<T>::Constant(others, k, T(0));  // what gives the others' rows
    Eigen::Index at = 0;
    for (const Alone& x : alone) {
      turned(at, x.first) = A(x.second, x.unknown);
      turned(at++, x.second) = -A(x.first, x.unknown);
      for (auto row : {x.first, x.second}) row_taken[static_cast<std::size_t>(row)] = true;
      taken[static_cast<std::size_t>(x.unknown)] = true;
    }
    for (Eigen::Index i = 0; i < k; ++i)
      if (!row_taken[static_cast<std::size_t>(i)]) turned(at++, i) = T(1);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index j = 0; j < k; ++j)
      if (!taken[static_cast<std::size_t>(j)]) kept.push_back(j);
    Mat<T> rest(others, others);
    for (Eigen::Index i = 0; i < others; ++i)
      for (Eigen::Index j = 0; j < others; ++j) {
        T sum(0);
        for (Eigen::Index r = 0; r < k; ++r) sum += turned(i, r) * A(r, kept[static_cast<std::size_t>(j)]);
        rest(i, j) = sum;
      }
    invert(rest);
    const Mat<T> of_others = inverse_.lazyProduct(turned);
    inverse_ = Mat<T>(k, k);
    for (Eigen::Index j = 0; j < others; ++j)
      inverse_.row(kept[static_cast<std::size_t>(j)]) = of_others.row(j);
    for (const Alone& x : alone) {
      const T scale = T(1) / x.squared, a = A(x.first, x.unknown) * scale, b = A(x.second, x.unknown) * scale;
      for (Eigen::Index c = 0; c < k; ++c) {
        T sum = c == x.first ? a : c == x.second ? b : T(0);
        for (Eigen::Index j = 0; j < others; ++j) {
          const Eigen::Index y = kept[static_cast<std::size_t>(j)];
          sum -= (a * A(x.first, y) + b * A(x.second, y)) * of_others(j, c);
        }
        inverse_(x.unknown, c) = sum;
      }
    }
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

// Compiled once for double, in procedure.cpp.
extern template class SmallSystem<double>;

}  // namespace mixloop
