// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/solve_closures.hpp"

namespace mixloop {

/// (1), (3): Q = Fc(Psi, t) and c_ij = d f_i / d psi_j, into ws.q (m) and ws.C (m x n).
template <class T>
void coordinates(const Model<T>& model, std::span<const T> psi, const T& t, Workspace<T>& ws) {
  if (model.scene->is_closed()) solve_closures(model, psi, t, ws);
  Vec<T>& direction = ws.out;
  for (int j = 0; j < model.n(); ++j) {
    for (int i = 0; i < model.n(); ++i) direction[i] = T(i == j ? 1 : 0);
    detail::CoordinatesAlong<T>(model, psi, direction.data(), t, T(0), ws).work_out(false);
    for (int i = 0; i < model.m(); ++i) ws.C(i, j) = ws.along[static_cast<std::size_t>(i)].d;
  }
  for (int i = 0; i < model.m(); ++i) ws.q[i] = ws.along[static_cast<std::size_t>(i)].v;
}

/// (2), (4): Q' = C Psi' + F_t and the part of Q'' that Psi'' has no share in,
/// (sum_k dC/dpsi_k psi'_k) Psi' + 2 F_psi,t Psi' + F_tt, into ws.qd and ws.q_bias (m).
template <class T>
void coordinate_rates(const Model<T>& model, std::span<const T> psi, std::span<const T> psid, const T& t,
                      Workspace<T>& ws) {
  detail::CoordinatesAlong<T>(model, psi, psid.data(), t, T(1), ws).work_out(true);
  for (int i = 0; i < model.m(); ++i) {
    ws.qd[i] = ws.along[static_cast<std::size_t>(i)].d;
    ws.q_bias[i] = ws.along[static_cast<std::size_t>(i)].dd;
  }
}

// Compiled once for double, in procedure.cpp.
extern template void coordinates(const Model<double>&, std::span<const double>, const double&,
                                 Workspace<double>&);
extern template void coordinate_rates(const Model<double>&, std::span<const double>, std::span<const double>,
                                      const double&, Workspace<double>&);

}  // namespace mixloop
