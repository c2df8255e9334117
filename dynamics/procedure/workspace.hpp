// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "dynamics/procedure/model.hpp"
#include "dynamics/procedure/small_system.hpp"

namespace mixloop {

/// The end effector at one instant, in the inertial frame.
template <class T>
struct EndEffectorState {
  Vec3<T> position, velocity, acceleration;  ///< m, m/s, m/s^2
  Mat<T> jacobian;                           ///< 3 x n: d position / d psi
};

template <class T>
struct Energy {
  T kinetic{0};
  T potential{0};  ///< of gravity, zero at the inertial frame's origin, and of springs
};

/// A link on the way from a load's end to where its chains part: the end, seen from the parent's origin in
/// axes turned by theta, and theta's cosine and sine.
template <class T>
struct LineStep {
  Vec3<T> arm;
  T cosine{1}, sine{0};
};

/// What an evaluation of the procedure writes; sized once, for one model.
template <class T>
struct Workspace {
  explicit Workspace(const Model<T>& model)
      : q(Vec<T>::Zero(model.m())),
        qd(q),
        q_bias(q),
        C(Mat<T>::Zero(model.m(), model.n())),
        along(static_cast<std::size_t>(model.m())),
        x(Vec<T>::Zero(model.m())),
        anchor_psi(model.n()),
        systems(model.scene->blocks.size()),
        frames(model.links.size() + 1),
        D(3, model.m()),
        O(3, model.m()),
        S(Mat<T>::Zero(model.m(), model.m())),
        a(Vec<T>::Zero(model.m())),
        SC(model.m(), model.n()),
        M(model.n(), model.n()),
        h(model.n()),
        out(model.n()),
        L(model.n(), model.n()),
        load(model.m()),
        on_psi(Vec<T>::Zero(model.n())),
        line(model.between_loads.empty() ? 0 : model.links.size()) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      auto& frame = frames[i];
      frame.T_0 << T(1), T(0), T(0), T(0), T(0), T(1), T(0), T(0), T(0), T(0), T(1), T(0);
      for (auto* matrix : {&frame.Td, &frame.Tdd_bias}) matrix->setConstant(T(0));
      Mat34<T> zero;
      zero.setConstant(T(0));
      frame.V.assign(model.path(static_cast<int>(i)).size(), zero);
    }
    end_effector.jacobian.resize(3, model.n());
    for (int j = 0; j < model.m(); ++j) x[j] = T(model.scene->coordinates[static_cast<std::size_t>(j)].home);
    anchor_x = x;
    for (int i = 0; i < model.n(); ++i) anchor_psi[i] = T(model.scene->home[static_cast<std::size_t>(i)]);
  }

  /// Of one frame: (6), (8), its rate, and the velocity products of (12).
  struct Frame {
    Mat34<T> T_0;             ///< [T]_0^i
    std::vector<Mat34<T>> V;  ///< [V]_j for each coordinate of the frame's path
    Mat34<T> Td;              ///< sum_j q'_j [V]_j
    Mat34<T> Tdd_bias;        ///< sum_j q'_j [V']_j
  };

  Vec<T> q, qd;                  ///< m: (1) and its rate, C psi' + F_t
  Vec<T> q_bias;                 ///< m: q'' where psi'' = 0
  Mat<T> C;                      ///< m x n, (3)
  std::vector<Taylor<T>> along;  ///< the coordinates along a line, while constraints are evaluated
  Vec<T> x;                      ///< m: of the solved coordinates, at the pose in hand
  Vec<T> anchor_x, anchor_psi;   ///< m, n: the last solution, from which the next is searched
  T anchor_t{0};
  bool is_anchored =
      false;              ///< the anchor holds for the model's parameters, not for the scene's defaults alone
  bool is_solved = true;  ///< whether the closures hold at the pose in hand; x is not finite where they don't
  /// Solves the closures in another way than by Newton's method on numbers.
  std::function<void(const Model<T>&, std::span<const T> psi, const T& t, Workspace&)> solve = nullptr;
  std::vector<SmallSystem<T>> systems;  ///< a block: its rows' slopes by its unknowns
  std::vector<Frame> frames;
  Mat<T> D, O;    ///< 3 x path: (9), (11) of the body in hand
  Mat<T> S;       ///< m x m: -sum [DD_i] (25)
  Vec<T> a;       ///< m: -sum [AD_i]^T (26)
  Mat<T> SC;      ///< m x n: S C
  Mat<T> M;       ///< n x n
  Vec<T> h, out;  ///< n
  Mat<T> L;       ///< n x n: LDL^T of M
  Vec<T> load;    ///< m
  EndEffectorState<T> end_effector;

  // Of loads along formulas and between points.
  Vec<T> on_psi;                  ///< n: what they take on psi itself
  std::vector<LineStep<T>> line;  ///< of the load in hand, a link each
};

// Compiled once for double, in procedure.cpp.
extern template struct Workspace<double>;

}  // namespace mixloop
