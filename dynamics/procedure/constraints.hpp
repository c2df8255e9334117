// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/workspace.hpp"

namespace mixloop {

namespace detail {

/// The coordinates along the line (psi + s dpsi, t + s dt), into ws.along.
template <class T>
void coordinates_along(const Model<T>& model, std::span<const T> psi, const T* dpsi, const T& t, const T& dt,
                       Workspace<T>& ws) {
  const Symbols symbols(*model.scene);
  const auto symbol = [&](int number) -> Taylor<T> {
    if (symbols.is_q(number)) return ws.along[static_cast<std::size_t>(number - symbols.q0)];
    if (symbols.is_psi(number)) {
      const auto i = static_cast<std::size_t>(number - symbols.psi0);
      return {psi[i], dpsi ? dpsi[i] : T(0), T(0)};
    }
    if (number == Symbols::kTime) return {t, dt, T(0)};
    return Taylor<T>(model.parameters[static_cast<std::size_t>(number - Symbols::kParameter0)]);
  };
  for (const int j : model.scene->evaluation_order)
    ws.along[static_cast<std::size_t>(j)] =
        evaluate<Taylor<T>>(model.scene->coordinates[static_cast<std::size_t>(j)].constraint, symbol);
}

}  // namespace detail

/// (1), (3): Q = Fc(Psi, t) and c_ij = d f_i / d psi_j, into ws.q (m) and ws.C (m x n).
template <class T>
void coordinates(const Model<T>& model, std::span<const T> psi, const T& t, Workspace<T>& ws) {
  Vec<T>& direction = ws.out;
  for (int j = 0; j < model.n(); ++j) {
    for (int i = 0; i < model.n(); ++i) direction[i] = T(i == j ? 1 : 0);
    detail::coordinates_along(model, psi, direction.data(), t, T(0), ws);
    for (int i = 0; i < model.m(); ++i) ws.C(i, j) = ws.along[static_cast<std::size_t>(i)].d;
  }
  for (int i = 0; i < model.m(); ++i) ws.q[i] = ws.along[static_cast<std::size_t>(i)].v;
}

/// (2), (4): Q' = C Psi' + F_t and the part of Q'' that Psi'' has no share in,
/// (sum_k dC/dpsi_k psi'_k) Psi' + 2 F_psi,t Psi' + F_tt, into ws.qd and ws.q_bias (m).
template <class T>
void coordinate_rates(const Model<T>& model, std::span<const T> psi, std::span<const T> psid, const T& t,
                      Workspace<T>& ws) {
  detail::coordinates_along(model, psi, psid.data(), t, T(1), ws);
  for (int i = 0; i < model.m(); ++i) {
    ws.qd[i] = ws.along[static_cast<std::size_t>(i)].d;
    ws.q_bias[i] = ws.along[static_cast<std::size_t>(i)].dd;
  }
}

}  // namespace mixloop
