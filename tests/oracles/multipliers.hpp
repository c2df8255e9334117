// SPDX-License-Identifier: MIT
// Forward dynamics of a tree of Denavit-Hartenberg transforms under constraints, by Newton-Euler and
// Lagrange multipliers. An oracle: vectors in the inertial frame instead of 4 x 4 matrices and their
// derivatives, the tree's mass matrix column by column from inverse dynamics, and the constraints kept as
// equations with multipliers instead of being substituted.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace mixloop::oracle {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <class T>
using MatrixX = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

enum class Motion { fixed, revolute, prismatic };

/// One transform of the tree, (A-1): Rz(theta) Tz(s) Tx(a) Rx(alpha) from its parent's frame to its own.
/// A revolute one adds scale * q to theta, a prismatic one to s.
template <class T>
struct TreeFrame {
  int parent = -1;  ///< index of an earlier frame, -1 the inertial frame
  T theta{}, s{}, a{}, alpha{};
  Motion motion = Motion::fixed;
  int coordinate = -1;  ///< index into q; several frames may share one
  T scale{1};
};

template <class T>
struct TreeBody {
  int frame = -1;
  T mass{};
  Vector3<T> centre = Vector3<T>::Zero();   ///< in the frame's axes
  Matrix3<T> inertia = Matrix3<T>::Zero();  ///< about the centre, in the frame's axes
};

/// A force at a point (in the frame's axes) with inertial components, and a moment in the frame's axes.
template <class T>
struct TreeLoad {
  int frame = -1;
  Vector3<T> point = Vector3<T>::Zero();
  Vector3<T> force = Vector3<T>::Zero();
  Vector3<T> moment = Vector3<T>::Zero();
};

/// The effort -stiffness (q - rest) - damping q' on a coordinate.
template <class T>
struct TreeSpring {
  int coordinate = 0;
  T stiffness{}, rest{}, damping{};
};

template <class T>
struct Tree {
  int coordinates = 0;
  std::vector<TreeFrame<T>> frames;
  std::vector<TreeBody<T>> bodies;
  std::vector<TreeLoad<T>> loads;
  std::vector<TreeSpring<T>> springs;
  Vector3<T> gravity = Vector3<T>::Zero();
};

/// Motion of a frame, all in inertial axes, at the frame's origin.
template <class T>
struct FrameMotion {
  Matrix3<T> R = Matrix3<T>::Identity();
  Vector3<T> p = Vector3<T>::Zero(), v = p, acceleration = p, w = p, w_rate = p;

  Vector3<T> acceleration_of(const Vector3<T>& r) const {
    return acceleration + w_rate.cross(r) + w.cross(w.cross(r));
  }
};

/// The motion of every frame, base to tip.
template <class T>
std::vector<FrameMotion<T>> frame_motions(const Tree<T>& tree, const VectorX<T>& q, const VectorX<T>& qd,
                                          const VectorX<T>& qdd) {
  using std::cos;
  using std::sin;
  std::vector<FrameMotion<T>> motions;
  motions.reserve(tree.frames.size());
  for (const TreeFrame<T>& frame : tree.frames) {
    const FrameMotion<T> parent = frame.parent < 0 ? FrameMotion<T>{} : motions[frame.parent];
    T theta = frame.theta, s = frame.s;
    Vector3<T> spin = Vector3<T>::Zero(), spin_rate = spin, slide = spin, slide_rate = spin;
    const Vector3<T> z = parent.R.col(2);
    if (frame.motion == Motion::revolute) {
      theta += frame.scale * q[frame.coordinate];
      spin = z * frame.scale * qd[frame.coordinate];
      spin_rate = z * frame.scale * qdd[frame.coordinate];
    } else if (frame.motion == Motion::prismatic) {
      s += frame.scale * q[frame.coordinate];
      slide = z * frame.scale * qd[frame.coordinate];
      slide_rate = z * frame.scale * qdd[frame.coordinate];
    }
    const Vector3<T> x = parent.R.col(0) * cos(theta) + parent.R.col(1) * sin(theta);
    const Vector3<T> y = z.cross(x);
    const Vector3<T> r = z * s + x * frame.a;
    FrameMotion<T> m;
    m.R.col(0) = x;
    m.R.col(1) = y * cos(frame.alpha) + z * sin(frame.alpha);
    m.R.col(2) = z * cos(frame.alpha) - y * sin(frame.alpha);
    m.w = parent.w + spin;
    m.w_rate = parent.w_rate + spin_rate + parent.w.cross(spin);
    m.p = parent.p + r;
    // r turns with the frame itself; the slide's own rate adds the Coriolis term.
    m.v = parent.v + m.w.cross(r) + slide;
    m.acceleration =
        parent.acceleration + m.w_rate.cross(r) + m.w.cross(m.w.cross(r)) + slide_rate + 2 * m.w.cross(slide);
    motions.push_back(m);
  }
  return motions;
}

/// Forces on the coordinates that the motion takes (Newton-Euler, tip to base), gravity and loads included.
template <class T>
VectorX<T> tree_inverse_dynamics(const Tree<T>& tree, const VectorX<T>& q, const VectorX<T>& qd,
                                 const VectorX<T>& qdd) {
  const auto motions = frame_motions(tree, q, qd, qdd);
  const std::size_t count = tree.frames.size();
  // What each frame must be given: a force, and a moment about the inertial origin.
  std::vector<Vector3<T>> force(count, Vector3<T>::Zero()), moment = force;
  for (const TreeBody<T>& body : tree.bodies) {
    const FrameMotion<T>& m = motions[body.frame];
    const Vector3<T> r = m.R * body.centre;
    const Vector3<T> f = body.mass * (m.acceleration_of(r) - tree.gravity);
    const Matrix3<T> I = m.R * body.inertia * m.R.transpose();
    const Vector3<T> Iw = I * m.w, centre = m.p + r;
    force[body.frame] += f;
    moment[body.frame] += I * m.w_rate + m.w.cross(Iw) + centre.cross(f);
  }
  for (const TreeLoad<T>& load : tree.loads) {
    const FrameMotion<T>& m = motions[load.frame];
    const Vector3<T> point = m.p + m.R * load.point;
    force[load.frame] -= load.force;
    moment[load.frame] -= m.R * load.moment + point.cross(load.force);
  }
  VectorX<T> effort = VectorX<T>::Zero(tree.coordinates);
  for (const TreeSpring<T>& spring : tree.springs)
    effort[spring.coordinate] +=
        spring.stiffness * (q[spring.coordinate] - spring.rest) + spring.damping * qd[spring.coordinate];
  for (std::size_t i = count; i-- > 0;) {
    const TreeFrame<T>& frame = tree.frames[i];
    const FrameMotion<T> parent = frame.parent < 0 ? FrameMotion<T>{} : motions[frame.parent];
    const Vector3<T> z = parent.R.col(2);
    if (frame.motion == Motion::revolute)
      effort[frame.coordinate] += frame.scale * z.dot(moment[i] - parent.p.cross(force[i]));
    else if (frame.motion == Motion::prismatic)
      effort[frame.coordinate] += frame.scale * z.dot(force[i]);
    if (frame.parent >= 0) {
      force[frame.parent] += force[i];
      moment[frame.parent] += moment[i];
    }
  }
  return effort;
}

/// The tree's mass matrix, one inverse dynamics a column, at rest and without gravity, loads or springs.
template <class T>
MatrixX<T> tree_mass_matrix(Tree<T> tree, const VectorX<T>& q) {
  tree.gravity.setZero();
  tree.loads.clear();
  tree.springs.clear();
  MatrixX<T> M(tree.coordinates, tree.coordinates);
  const VectorX<T> rest = VectorX<T>::Zero(tree.coordinates);
  for (int j = 0; j < tree.coordinates; ++j)
    M.col(j) = tree_inverse_dynamics(tree, q, rest, VectorX<T>(VectorX<T>::Unit(tree.coordinates, j)));
  return M;
}

template <class T>
VectorX<T> tree_bias(const Tree<T>& tree, const VectorX<T>& q, const VectorX<T>& qd) {
  return tree_inverse_dynamics(tree, q, qd, VectorX<T>(VectorX<T>::Zero(tree.coordinates)));
}

/// Constraints at one instant: q, C = dq/dpsi, q' and the part gamma of q'' that has no psi''.
template <class T>
struct ConstraintState {
  VectorX<T> q, qd, gamma;
  MatrixX<T> C;
};

template <class T>
struct MultiplierSolution {
  VectorX<T> qdd, psidd, multipliers;
};

/// Accelerations x'' and multipliers of M x'' + G^T lambda = force, G x'' = gamma.
template <class T>
VectorX<T> augmented_solve(const MatrixX<T>& M, const MatrixX<T>& G, const VectorX<T>& force,
                           const VectorX<T>& gamma) {
  const auto unknowns = M.rows(), rows = G.rows();
  MatrixX<T> A = MatrixX<T>::Zero(unknowns + rows, unknowns + rows);
  A.topLeftCorner(unknowns, unknowns) = M;
  A.topRightCorner(unknowns, rows) = G.transpose();
  A.bottomLeftCorner(rows, unknowns) = G;
  VectorX<T> right(unknowns + rows);
  right << force, gamma;
  return Eigen::FullPivLU<MatrixX<T>>(A).solve(right);
}

/// Forward dynamics with motor forces tau: unknowns (q'', psi'', lambda), constraints q'' - C psi'' = gamma.
template <class T>
MultiplierSolution<T> multiplier_forward_dynamics(const Tree<T>& tree, const ConstraintState<T>& state,
                                                  const VectorX<T>& tau) {
  const Eigen::Index m = tree.coordinates, n = state.C.cols();
  MatrixX<T> M = MatrixX<T>::Zero(m + n, m + n), G(m, m + n);
  M.topLeftCorner(m, m) = tree_mass_matrix(tree, state.q);
  G << MatrixX<T>::Identity(m, m), -state.C;
  VectorX<T> force(m + n);
  force << -tree_bias(tree, state.q, state.qd), tau;
  const VectorX<T> x = augmented_solve(M, G, force, state.gamma);
  return {x.head(m), x.segment(m, n), x.tail(m)};
}

/// Motor forces that psidd takes, by virtual work over the tree's efforts.
template <class T>
VectorX<T> multiplier_inverse_dynamics(const Tree<T>& tree, const ConstraintState<T>& state,
                                       const VectorX<T>& psidd) {
  const VectorX<T> qdd = state.C * psidd + state.gamma;
  return state.C.transpose() * tree_inverse_dynamics(tree, state.q, state.qd, qdd);
}

}  // namespace mixloop::oracle
