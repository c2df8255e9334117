// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>

#include "dynamics/procedure/matrix.hpp"
#include "integrators/coefficient.hpp"

namespace mixloop {

/// An explicit Runge-Kutta method with an embedded one, for states x and rates x' = f(t, x):
///   k_i = f(t + c_i h, x + h sum_j a_ij k_j),  x+ = x + h sum_i b_i k_i
/// `Table` has kStages, kOrder, kC[i], kA[i][j] (null where zero; row kStages is b), and an `Estimate`.
/// Nothing allocates after construction.
template <class Table, class T>
class ExplicitRungeKutta {
 public:
  static constexpr std::size_t kStages = Table::kStages;
  static constexpr int kOrder = Table::kOrder;

  ExplicitRungeKutta(Eigen::Index, Eigen::Index size) : x_(size), next_(size), sum_(size) {
    for (auto& k : k_) k = Vec<T>::Zero(size);
    for (std::size_t i = 0; i <= kStages; ++i) {
      c_[i] = i < kStages ? coefficient<T>(Table::kC[i]) : T(1);
      for (std::size_t j = 0; j < kStages; ++j)
        a_[i][j] = Table::kA[i][j] ? coefficient<T>(Table::kA[i][j]) : T(0);
    }
  }

  void begin() {}

  /// In place. `rate(stage, c, x, dx)` writes x' at t + c h.
  template <class Rate>
  void step(Vec<T>& x, const T& h, const Rate& rate) {
    rate(0, c_[0], x, k_[0]);
    try_step(x, h, rate);
    x.swap(next_);
  }

  /// As step, what is rounded away kept in `carry` and given back at the next step (Kahan; Hairer, Lubich &
  /// Wanner, Geometric Numerical Integration, VIII.5): for many small steps on end.
  template <class Rate>
  void compensated_step(Vec<T>& x, Vec<T>& carry, const T& h, const Rate& rate) {
    rate(0, c_[0], x, k_[0]);
    stages<1>(x, h, rate);
    for (Eigen::Index r = 0; r < x.size(); ++r) {
      const T increment = carry[r] + h * weighted<kStages>(r);
      const T before = x[r];
      x[r] += increment;
      carry[r] = increment - (x[r] - before);
    }
  }

  /// k_1, which rejected steps share.
  template <class Rate>
  void first_stage(const Vec<T>& x, const Rate& rate) {
    rate(0, c_[0], x, k_[0]);
  }
  /// The stages after the first, and the step's end into `next()`; x stays.
  template <class Rate>
  void try_step(const Vec<T>& x, const T& h, const Rate& rate) {
    stages<1>(x, h, rate);
    combine<kStages>(x, h, next_);
  }
  /// f at the step's end, which the estimate and the next step use.
  template <class Rate>
  void last_stage(const Rate& rate) {
    rate(static_cast<int>(kStages), T(1), next_, k_[kStages]);
  }
  const Vec<T>& next() const { return next_; }
  /// The estimate h |sum_i e_i k_i| of the step's error in the norm that `norm` takes; after last_stage.
  template <class Norm>
  T error(const T& h, const Norm& norm) {
    using std::abs;
    return abs(h) * estimate_(k_, a_[kStages], sum_, norm);
  }
  /// Accepts the step: x moves to its end, and k_1 is known.
  void accept(Vec<T>& x) {
    x.swap(next_);
    k_[0].swap(k_[kStages]);
  }

  const std::array<Vec<T>, kStages + 1>& slopes() const { return k_; }

 private:
  template <std::size_t I>
  static constexpr std::size_t count() {
    std::size_t n = 0;
    for (std::size_t j = 0; j < kStages; ++j) n += Table::kA[I][j] != nullptr;
    return n;
  }
  template <std::size_t I>
  static constexpr auto columns() {
    std::array<std::size_t, count<I>()> used{};
    std::size_t n = 0;
    for (std::size_t j = 0; j < kStages; ++j)
      if (Table::kA[I][j]) used[n++] = j;
    return used;
  }

  /// sum_j a_Ij k_j of row r.
  template <std::size_t I>
  T weighted(Eigen::Index r) const {
    constexpr auto used = columns<I>();
    return [&]<std::size_t... J>(std::index_sequence<J...>) {
      return ((a_[I][used[J]] * k_[used[J]][r]) + ...);
    }
    (std::make_index_sequence<used.size()>());
  }

  template <std::size_t I>
  void combine(const Vec<T>& x, const T& h, Vec<T>& out) const {
    constexpr auto used = columns<I>();
    [&]<std::size_t... J>(std::index_sequence<J...>) {
      const std::array<const T*, used.size()> k{k_[used[J]].data()...};
      const std::array<T, used.size()> a{a_[I][used[J]]...};
      const Eigen::Index size = x.size();
      const T* from = x.data();
      T* to = out.data();
      for (Eigen::Index r = 0; r < size; ++r) to[r] = from[r] + h * ((a[J] * k[J][r]) + ...);
    }
    (std::make_index_sequence<used.size()>());
  }

  template <std::size_t I, class Rate>
  void stages(const Vec<T>& x, const T& h, const Rate& rate) {
    if constexpr (I < kStages) {
      combine<I>(x, h, x_);
      rate(static_cast<int>(I), c_[I], x_, k_[I]);
      stages<I + 1>(x, h, rate);
    }
  }

  std::array<Vec<T>, kStages + 1> k_;
  std::array<std::array<T, kStages>, kStages + 1> a_;
  std::array<T, kStages + 1> c_;
  typename Table::template Estimate<T> estimate_;
  Vec<T> x_, next_, sum_;
};

}  // namespace mixloop
