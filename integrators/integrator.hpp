// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <type_traits>
#include <variant>

#include "integrators/dop853.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/error_control.hpp"
#include "integrators/gauss.hpp"
#include "integrators/leapfrog.hpp"
#include "integrators/method.hpp"
#include "integrators/rk4.hpp"
#include "integrators/rosenbrock.hpp"
#include "integrators/semi_implicit_euler.hpp"

namespace mixloop {

struct IntegratorSettings {
  Method method = Method::rk4;
  int substeps = 1;        ///< equal steps in a piece
  double local_error = 0;  ///< above 0: the method chooses its steps to keep this error (error_size) in each
};

/// One method with its workspace, on any scalar, advancing states (q, v, rest) over pieces on which nothing
/// jumps. Each piece starts afresh: the result depends on the state and the piece alone. Nothing allocates
/// after construction.
template <class T = double>
class Integrator {
 public:
  /// At most so many steps in a piece under error control; what would take more becomes not a number.
  static constexpr int kMostSteps = 10000;

  /// n numbers of q, `size` in all.
  Integrator(const IntegratorSettings& settings, Eigen::Index n, Eigen::Index size)
      : settings_(settings), n_(n), steps_(make(settings.method, n, size)) {}

  const IntegratorSettings& settings() const { return settings_; }

  /// Advances x over `length`. `rate(step, stage, t, x, dx)` writes x' at time t from the piece's start
  /// (stage 0 and up; -1 under error control); `linearise(t, x, jacobian)` is called by methods that take a
  /// Jacobian.
  template <class Rate, class Linearise>
  void advance(Vec<T>& x, double length, const Rate& rate, const Linearise& linearise) {
    std::visit([&](auto& method) { run(method, x, length, rate, linearise); }, steps_);
  }

 private:
  using Any = std::variant<SemiImplicitEuler<T>, Leapfrog<T>, Rk4<T>, DormandPrince<T>, Dop853<T>,
                           Gauss<T, 4>, Rodas3<T>, Rodas4<T>>;
  template <class M>
  static constexpr bool kLinearises = std::is_same_v<M, Rodas3<T>> || std::is_same_v<M, Rodas4<T>>;
  template <class M>
  static constexpr bool kEstimates = std::is_same_v<M, DormandPrince<T>> || std::is_same_v<M, Dop853<T>>;

  template <std::size_t I = 0>
  static Any make(Method method, Eigen::Index n, Eigen::Index size) {
    if constexpr (I + 1 < std::variant_size_v<Any>)
      if (static_cast<std::size_t>(method) != I) return make<I + 1>(method, n, size);
    return Any(std::in_place_index<I>, n, size);
  }

  template <class M, class Rate, class Linearise>
  void run(M& method, Vec<T>& x, double length, const Rate& rate, const Linearise& linearise) {
    method.begin();
    if constexpr (kEstimates<M>) {
      if (settings_.local_error > 0) return run_controlled(method, x, length, rate);
    }
    const T h = T(length) / settings_.substeps;
    for (int step = 0; step < settings_.substeps; ++step) {
      const auto at = [&](int stage, const T& c, const Vec<T>& state, Vec<T>& dx) {
        rate(step, stage, (step + c) * h, state, dx);
      };
      if constexpr (kLinearises<M>)
        method.step(x, h, at,
                    [&](const Vec<T>& state, auto& jacobian) { linearise(step * h, state, jacobian); });
      else
        method.step(x, h, at);
    }
  }

  template <class M, class Rate>
  void run_controlled(M& method, Vec<T>& x, double length, const Rate& rate) {
    const auto at = [&](const T& t, const Vec<T>& state, Vec<T>& dx) { rate(0, -1, t, state, dx); };
    if (!controlled_steps(method, x, n_, T(length), T(settings_.local_error), kMostSteps, at).finished)
      x.setConstant(T(std::numeric_limits<double>::quiet_NaN()));
  }

  IntegratorSettings settings_;
  Eigen::Index n_;
  Any steps_;
};

// Compiled once for double, in method.cpp.
extern template class Integrator<double>;

}  // namespace mixloop
