// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

namespace mixloop {

template <class T>
using Vec = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <class T>
using Mat = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Mat3 = Eigen::Matrix<T, 3, 3>;
/// The upper three rows of a homogeneous matrix; of a transform the fourth is (0 0 0 1), of its
/// derivatives (0 0 0 0).
template <class T>
using Mat34 = Eigen::Matrix<T, 3, 4>;

using Vector = Vec<double>;
using Matrix = Mat<double>;

template <class T>
std::span<const T> span_of(const Vec<T>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
template <class T>
std::span<const T> span_of(const Eigen::Map<const Vec<T>>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
template <class T>
std::span<T> span_of(Vec<T>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
template <class T>
Eigen::Map<const Vec<T>> map_of(std::span<const T> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

}  // namespace mixloop
