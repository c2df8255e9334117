// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/procedure.hpp"
#include "dynamics/procedure/purpose.hpp"

namespace mixloop {

namespace detail {

template <class T, class Derived>
T* put(const Eigen::MatrixBase<Derived>& values, T* out) {
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i) *out++ = values(i, j);
  return out;
}

/// The motors' rows of M a, a nothing elsewhere.
template <class T>
void put_mass_times(const Model<T>& model, std::span<const T> psi, std::span<const T> a, const T& t,
                    Workspace<T>& ws, T* out) {
  const Mat<T>& M = mass_matrix(model, psi, t, ws);
  for (int i = 0; i < model.n_u(); ++i) {
    out[i] = M(i, 0) * a[0];
    for (int j = 1; j < model.n_u(); ++j) out[i] += M(i, j) * a[static_cast<std::size_t>(j)];
  }
}

}  // namespace detail

/// What a purpose gives, by the procedure; spans may be longer than it takes. Not of linearisation, whose
/// derivatives it doesn't know.
template <class T>
void put_outputs(Purpose purpose, const Model<T>& model, std::span<const T> psi, std::span<const T> psid,
                 std::span<const T> input, const T& t, Workspace<T>& ws, T* out) {
  using detail::put;
  const auto n = static_cast<std::size_t>(model.n()), n_u = static_cast<std::size_t>(model.n_u());
  switch (purpose) {
    case Purpose::forward_dynamics:
      put(forward_dynamics(model, psi, psid, input, t, ws), out);
      break;
    case Purpose::mass_times:
      detail::put_mass_times(model, psi, input, t, ws, out);
      break;
    case Purpose::mass_matrix:
      put(mass_matrix(model, psi, t, ws), out);
      break;
    case Purpose::bias:
      put(bias(model, psi, psid, t, ws), out);
      break;
    case Purpose::inverse_dynamics:
      put(inverse_dynamics(model, psi, psid, input.first(n), t, ws), out);
      break;
    case Purpose::end_effector: {
      const auto& state = end_effector(model, psi, psid, input, t, ws);
      put(state.jacobian, put(state.acceleration, put(state.velocity, put(state.position, out))));
      break;
    }
    case Purpose::energy: {
      const Energy<T> sum = energy(model, psi, psid, t, ws);
      out[0] = sum.kinetic;
      out[1] = sum.potential;
      break;
    }
    case Purpose::dynamics_and_mass_times:
      put(forward_dynamics(model, psi, psid, input, t, ws), out);
      detail::put_mass_times(model, psi, input.subspan(n_u), t, ws, out + n);
      break;
    case Purpose::linearisation:
      break;
  }
}

}  // namespace mixloop
