// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/bodies.hpp"
#include "dynamics/procedure/constraints.hpp"
#include "dynamics/procedure/ldlt.hpp"
#include "dynamics/procedure/line_loads.hpp"

/// Dado's procedure, equations (1) to (32), on any scalar T: double evaluates, a wide float is the oracle,
/// a recording scalar gives the graph of the computation. Signs: M Psi'' + h = tau, M = -DM positive
/// definite, h = -FE. Nothing allocates; results are references into the workspace, valid until its next use.
namespace mixloop {

namespace detail {

template <class T>
void project_mass(const Model<T>& model, Workspace<T>& ws) {
  // (31) M = C^T (sum -DD_i) C
  ws.SC.noalias() = ws.S.lazyProduct(ws.C);
  for (int i = 0; i < model.n(); ++i)
    for (int j = 0; j <= i; ++j) ws.M(i, j) = ws.M(j, i) = ws.C.col(i).dot(ws.SC.col(j));
}

template <class T>
void project_bias(const Model<T>& model, Workspace<T>& ws) {
  // (32) h = C^T [ sum -AD_i^T + (sum -DD_i) (C' Psi' + F_tt) ]
  ws.load.noalias() = ws.S.lazyProduct(ws.q_bias);
  ws.load += ws.a;
  for (int i = 0; i < model.n(); ++i) ws.h[i] = ws.C.col(i).dot(ws.load);
  if (!model.along_loads.empty()) ws.h += ws.on_psi;
}

/// tau - h, n: what motors give along psi, or by virtual work along a coordinate, C^T tau.
template <class T>
void driving_forces(const Model<T>& model, std::span<const T> tau, Workspace<T>& ws) {
  const auto& along = model.scene->acts_along;
  for (int i = 0; i < model.n(); ++i) {
    const auto motor = static_cast<std::size_t>(i);
    const bool is_driven = i < model.n_u() && (along.empty() || along[motor] < 0);
    ws.out[i] = is_driven ? T(tau[motor] - ws.h[i]) : T(-ws.h[i]);
  }
  for (std::size_t motor = 0; motor < along.size(); ++motor)
    if (along[motor] >= 0) ws.out += ws.C.row(along[motor]).transpose() * tau[motor];
}

template <class T>
void assemble(const Model<T>& model, std::span<const T> psi, std::span<const T> psid, const T& t,
              Workspace<T>& ws) {
  coordinates(model, psi, t, ws);
  coordinate_rates(model, psi, psid, t, ws);
  frame_variations(model, ws);
  frame_rates(model, ws);
  dynamic_matrix(model, ws);
  dynamic_vector(model, t, ws);
  ws.on_psi.setConstant(T(0));
  add_line_loads(model, {psi, psid, ws.q, ws.qd, t}, ws.line, ws.a, ws.on_psi);
  project_bias(model, ws);
}

}  // namespace detail

/// (31): n x n, symmetric.
template <class T>
const Mat<T>& mass_matrix(const Model<T>& model, std::span<const T> psi, const T& t, Workspace<T>& ws) {
  coordinates(model, psi, t, ws);
  frame_variations(model, ws);
  dynamic_matrix(model, ws);
  detail::project_mass(model, ws);
  return ws.M;
}

/// (32) with the project's sign: n, N m or N.
template <class T>
const Vec<T>& bias(const Model<T>& model, std::span<const T> psi, std::span<const T> psid, const T& t,
                   Workspace<T>& ws) {
  detail::assemble(model, psi, psid, t, ws);
  return ws.h;
}

/// (30) for tau: M psi'' + h, n.
template <class T>
const Vec<T>& inverse_dynamics(const Model<T>& model, std::span<const T> psi, std::span<const T> psid,
                               std::span<const T> psidd, const T& t, Workspace<T>& ws) {
  detail::assemble(model, psi, psid, t, ws);
  detail::project_mass(model, ws);
  ws.out.noalias() = ws.M.lazyProduct(map_of(psidd));
  ws.out += ws.h;
  return ws.out;
}

/// (30) for psi'': M^-1 (tau - h), n, for the motors' tau, n_u. Not finite where M is singular.
template <class T>
const Vec<T>& forward_dynamics(const Model<T>& model, std::span<const T> psi, std::span<const T> psid,
                               std::span<const T> tau, const T& t, Workspace<T>& ws) {
  detail::assemble(model, psi, psid, t, ws);
  detail::project_mass(model, ws);
  detail::driving_forces(model, tau, ws);
  ws.L = ws.M;
  factor_ldlt(ws.L);
  solve_ldlt(ws.L, ws.out);
  return ws.out;
}

/// The end effector's place (5), rate and acceleration (14), and its Jacobian D C.
template <class T>
const EndEffectorState<T>& end_effector(const Model<T>& model, std::span<const T> psi,
                                        std::span<const T> psid, std::span<const T> psidd, const T& t,
                                        Workspace<T>& ws) {
  coordinates(model, psi, t, ws);
  coordinate_rates(model, psi, psid, t, ws);
  frame_variations(model, ws);
  frame_rates(model, ws);
  const int index = model.scene->end_effector.frame;
  const auto& frame = ws.frames[static_cast<std::size_t>(index)];
  const auto& path = model.path(index);
  auto& out = ws.end_effector;
  out.position = at_point<T>(frame.T_0, model.end_effector_point);
  out.velocity = at_point<T>(frame.Td, model.end_effector_point);
  out.acceleration = at_point<T>(frame.Tdd_bias, model.end_effector_point);
  linear_variations<T>(frame, model.end_effector_point, ws.D);
  out.jacobian.setConstant(T(0));
  for (std::size_t j = 0; j < path.size(); ++j) {
    const auto column = ws.D.col(static_cast<Eigen::Index>(j));
    out.acceleration += column * ws.q_bias[path[j]];
    for (int i = 0; i < model.n(); ++i) out.jacobian.col(i) += column * ws.C(path[j], i);
  }
  for (int i = 0; i < model.n(); ++i)
    out.acceleration += out.jacobian.col(i) * psidd[static_cast<std::size_t>(i)];
  return out;
}

/// Kinetic energy 1/2 Q'^T S Q' and the potential of gravity and springs.
template <class T>
Energy<T> energy(const Model<T>& model, std::span<const T> psi, std::span<const T> psid, const T& t,
                 Workspace<T>& ws) {
  coordinates(model, psi, t, ws);
  coordinate_rates(model, psi, psid, t, ws);
  frame_variations(model, ws);
  dynamic_matrix(model, ws);
  ws.load.noalias() = ws.S.lazyProduct(ws.qd);
  Energy<T> result;
  result.kinetic = ws.qd.dot(ws.load) / T(2);
  for (const auto& body : model.bodies) {
    const Vec3<T> place =
        at_point<T>(ws.frames[static_cast<std::size_t>(body.frame)].T_0, body.center_of_mass);
    result.potential -= body.mass * model.gravity.dot(place);
  }
  result.potential += spring_potential(model, ws.q);
  if (!model.along_loads.empty() || !model.between_loads.empty())
    result.potential += line_potential(model, {psi, psid, ws.q, ws.qd, t}, ws.line);
  return result;
}

// Compiled once for double, in procedure.cpp.
extern template const Mat<double>& mass_matrix(const Model<double>&, std::span<const double>, const double&,
                                               Workspace<double>&);
extern template const Vec<double>& bias(const Model<double>&, std::span<const double>,
                                        std::span<const double>, const double&, Workspace<double>&);
extern template const Vec<double>& inverse_dynamics(const Model<double>&, std::span<const double>,
                                                    std::span<const double>, std::span<const double>,
                                                    const double&, Workspace<double>&);
extern template const Vec<double>& forward_dynamics(const Model<double>&, std::span<const double>,
                                                    std::span<const double>, std::span<const double>,
                                                    const double&, Workspace<double>&);
extern template const EndEffectorState<double>& end_effector(const Model<double>&, std::span<const double>,
                                                             std::span<const double>, std::span<const double>,
                                                             const double&, Workspace<double>&);
extern template Energy<double> energy(const Model<double>&, std::span<const double>, std::span<const double>,
                                      const double&, Workspace<double>&);

}  // namespace mixloop
