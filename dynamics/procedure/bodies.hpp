// SPDX-License-Identifier: MIT
#pragma once

#include "dynamics/procedure/kinematics.hpp"

namespace mixloop {

/// (25), (27): adds every body's -[DD_i] into ws.S (m x m), from ws.frames.
template <class T>
void dynamic_matrix(const Model<T>& model, Workspace<T>& ws) {
  ws.S.setConstant(T(0));
  for (const auto& body : model.bodies) {
    const auto& path = model.path(body.frame);
    const auto k = static_cast<Eigen::Index>(path.size());
    const auto& frame = ws.frames[static_cast<std::size_t>(body.frame)];
    linear_variations<T>(frame, body.center_of_mass, ws.D);
    angular_variations<T>(frame, ws.O);
    // -DD_i = m D^T D + O^T I O
    for (Eigen::Index j = 0; j < k; ++j) {
      const Vec3<T> mD = ws.D.col(j) * body.mass;
      const Vec3<T> IO = body.inertia.lazyProduct(ws.O.col(j));
      for (Eigen::Index i = 0; i <= j; ++i) {
        const T element = ws.D.col(i).dot(mD) + ws.O.col(i).dot(IO);
        const int row = path[static_cast<std::size_t>(i)], column = path[static_cast<std::size_t>(j)];
        ws.S(row, column) += element;
        if (row != column) ws.S(column, row) += element;
      }
    }
  }
}

/// (21), last two terms: forces in inertial axes at a point, moments in the frame's axes.
template <class T>
void external_loads(const Model<T>& model, const T& t, Workspace<T>& ws) {
  const auto timed = [&](int symbol) -> T {
    return symbol == Symbols::kTime
               ? t
               : model.parameters[static_cast<std::size_t>(symbol - Symbols::kParameter0)];
  };
  for (std::size_t l = 0; l < model.loads.size(); ++l) {
    const auto& load = model.loads[l];
    const auto& said = model.scene->loads[l];
    Vec3<T> force, moment;
    for (std::size_t i = 0; i < 3; ++i) {
      force[static_cast<Eigen::Index>(i)] = evaluate<T>(said.force[i], timed);
      moment[static_cast<Eigen::Index>(i)] = evaluate<T>(said.moment[i], timed);
    }
    const auto& path = model.path(load.frame);
    const auto& frame = ws.frames[static_cast<std::size_t>(load.frame)];
    linear_variations<T>(frame, load.point, ws.D);
    angular_variations<T>(frame, ws.O);
    for (std::size_t j = 0; j < path.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      ws.a[path[j]] -= ws.D.col(column).dot(force) + ws.O.col(column).dot(moment);
    }
  }
}

/// Springs and viscous friction at the coordinates, as what the motion takes: k (q - rest) + d q', m.
template <class T, class Out>
void add_coordinate_loads(const Model<T>& model, const Vec<T>& q, const Vec<T>& qd, Out& a) {
  for (const auto& load : model.coordinate_loads)
    a[load.coordinate] +=
        load.stiffness * (q[load.coordinate] - load.rest) + load.damping * qd[load.coordinate];
}

/// What the springs hold: sum k/2 (q - rest)^2.
template <class T>
T spring_potential(const Model<T>& model, const Vec<T>& q) {
  T sum(0);
  for (const auto& load : model.coordinate_loads) {
    const T stretch = q[load.coordinate] - load.rest;
    sum += load.stiffness * stretch * stretch / T(2);
  }
  return sum;
}

/// (26), (27): adds every body's -[AD_i]^T into ws.a (m): velocity products, gravity, external loads (21).
template <class T>
void dynamic_vector(const Model<T>& model, const T& t, Workspace<T>& ws) {
  ws.a.setConstant(T(0));
  for (const auto& body : model.bodies) {
    const auto& path = model.path(body.frame);
    const auto& frame = ws.frames[static_cast<std::size_t>(body.frame)];
    linear_variations<T>(frame, body.center_of_mass, ws.D);
    angular_variations<T>(frame, ws.O);
    Vec3<T> rate;  // (20) Phi' = O Q'
    rate.setConstant(T(0));
    for (std::size_t j = 0; j < path.size(); ++j)
      rate += ws.O.col(static_cast<Eigen::Index>(j)) * ws.qd[path[j]];
    const Mat3<T> Omega = detail::skew_of_vector<T>(rate);                // (19)
    const Vec3<T> Ap = at_point<T>(frame.Tdd_bias, body.center_of_mass);  // (16)
    const Mat3<T> Ao_skew =
        frame.T_0.template leftCols<3>().transpose().lazyProduct(frame.Tdd_bias.template leftCols<3>()) -
        Omega.lazyProduct(Omega);
    const Vec3<T> Ao = detail::vector_of_skew<T>(Ao_skew);   // (18)
    const Vec3<T> force = (Ap - model.gravity) * body.mass;  // (22) less gravity
    const Vec3<T> I_rate = body.inertia.lazyProduct(rate);
    const Vec3<T> moment = body.inertia.lazyProduct(Ao) + Omega.lazyProduct(I_rate);  // (23)
    for (std::size_t j = 0; j < path.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      ws.a[path[j]] += ws.D.col(column).dot(force) + ws.O.col(column).dot(moment);
    }
  }
  external_loads(model, t, ws);
  add_coordinate_loads(model, ws.q, ws.qd, ws.a);
}

}  // namespace mixloop
