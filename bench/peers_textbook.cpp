// SPDX-License-Identifier: MIT
// The textbook route in Eigen: composite-body mass matrix and recursive Newton-Euler of the open tree of
// six joints, in link frames and fixed sizes, then projected with the constant C and solved by LLT.
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "bench/engine.hpp"
#include "bench/robot_tree.hpp"

namespace mixloop::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

/// Mass, first moment and inertia about the frame's origin.
struct SpatialInertia {
  double m = 0;
  Vector3d mc = Vector3d::Zero();
  Matrix3d I = Matrix3d::Zero();
};

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d X;
  X << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return X;
}

class TextbookRobot {
 public:
  TextbookRobot() {
    for (int i = 0; i < kJoints; ++i) {
      const TreeJoint& joint = kTree[i];
      const double s = std::sin(joint.alpha), c = std::cos(joint.alpha);
      offset_[i] = {joint.a, 0, joint.s};
      twist_[i] << 1, 0, 0, 0, c, -s, 0, s, c;
      const Vector3d centre(joint.centre[0], joint.centre[1], joint.centre[2]);
      const Vector3d diagonal(joint.inertia[0], joint.inertia[1], joint.inertia[2]);
      add(i, joint.mass, centre, diagonal.asDiagonal());
    }
    add(kEndEffectorJoint, kPayload, Vector3d::Zero(), Matrix3d::Zero());
    for (int i = 0; i < kJoints; ++i)
      for (int j = 0; j < 3; ++j) C_(i, j) = kCoupling[i][j];
    q0_ = Vector6(kCouplingOffset.data());
  }

  void forward(const State& state, Triple& psidd) const {
    const Eigen::Map<const Vector3d> psi(state.psi.data()), psid(state.psid.data()), tau(state.tau.data());
    Frames frames;
    place(C_ * psi + q0_, frames);
    const Vector6 h = bias(frames, C_ * psid);
    const Matrix3d M = C_.transpose() * mass(frames) * C_;
    Eigen::Map<Vector3d>(psidd.data()) = M.llt().solve(tau - C_.transpose() * h);
  }

  void mass_matrix(const State& state, MassMatrix& upper) const {
    Frames frames;
    place(C_ * Eigen::Map<const Vector3d>(state.psi.data()) + q0_, frames);
    const Matrix3d M = C_.transpose() * mass(frames) * C_;
    upper = {M(0, 0), M(0, 1), M(0, 2), M(1, 1), M(1, 2), M(2, 2)};
  }

 private:
  /// Rotation and origin of each joint's frame in its parent's.
  struct Frames {
    std::array<Matrix3d, kJoints> R;
    std::array<Vector3d, kJoints> p;
  };

  /// A body given in its link frame, moved to the joint's frame.
  void add(int i, double mass, const Vector3d& centre, const Matrix3d& inertia) {
    const Vector3d c = offset_[i] + twist_[i] * centre;
    body_[i].m += mass;
    body_[i].mc += mass * c;
    body_[i].I += twist_[i] * inertia * twist_[i].transpose() - mass * cross_matrix(c) * cross_matrix(c);
  }

  void place(const Vector6& q, Frames& frames) const {
    for (int i = 0; i < kJoints; ++i) {
      const double s = std::sin(q[i]), c = std::cos(q[i]);
      const int parent = kTree[i].parent;
      Matrix3d turn;
      turn << c, -s, 0, s, c, 0, 0, 0, 1;
      frames.R[i] = parent < 0 ? turn : Matrix3d(twist_[parent] * turn);
      frames.p[i] = parent < 0 ? Vector3d(Vector3d::Zero()) : offset_[parent];
    }
  }

  Matrix6 mass(const Frames& frames) const {
    std::array<SpatialInertia, kJoints> composite = body_;
    Matrix6 M = Matrix6::Zero();
    for (int i = kJoints; i-- > 0;) {
      // The force and moment at the origin that a unit acceleration of joint i takes.
      Vector3d f = Vector3d::UnitZ().cross(composite[i].mc), moment = composite[i].I.col(2);
      M(i, i) = moment[2];
      for (int j = i; kTree[j].parent >= 0;) {
        f = frames.R[j] * f;
        moment = frames.R[j] * moment + frames.p[j].cross(f);
        j = kTree[j].parent;
        M(i, j) = M(j, i) = moment[2];
      }
      if (const int parent = kTree[i].parent; parent >= 0)
        transfer(frames, i, composite[i], composite[parent]);
    }
    return M;
  }

  static void transfer(const Frames& frames, int i, const SpatialInertia& from, SpatialInertia& to) {
    const Matrix3d& R = frames.R[i];
    const Vector3d& p = frames.p[i];
    const Vector3d mc = R * from.mc;
    const Matrix3d P = cross_matrix(p), X = cross_matrix(mc);
    to.I += R * from.I * R.transpose() - P * X - X * P - from.m * P * P;
    to.mc += mc + from.m * p;
    to.m += from.m;
  }

  Vector6 bias(const Frames& frames, const Vector6& qd) const {
    std::array<Vector3d, kJoints> w, w_rate, acceleration, f, moment;
    for (int i = 0; i < kJoints; ++i) {
      const int parent = kTree[i].parent;
      const Matrix3d Rt = frames.R[i].transpose();
      const Vector3d spin = qd[i] * Vector3d::UnitZ();
      const Vector3d w0 = parent < 0 ? Vector3d(Vector3d::Zero()) : w[parent];
      const Vector3d w0_rate = parent < 0 ? Vector3d(Vector3d::Zero()) : w_rate[parent];
      const Vector3d a0 = parent < 0 ? Vector3d(0, 0, kGravity) : acceleration[parent];
      const Vector3d& p = frames.p[i];
      w[i] = Rt * w0 + spin;
      w_rate[i] = Rt * w0_rate + w[i].cross(spin);
      acceleration[i] = Rt * (a0 + w0_rate.cross(p) + w0.cross(w0.cross(p)));
      const SpatialInertia& body = body_[i];
      f[i] = body.m * acceleration[i] + w_rate[i].cross(body.mc) + w[i].cross(w[i].cross(body.mc));
      moment[i] = body.I * w_rate[i] + w[i].cross(body.I * w[i]) + body.mc.cross(acceleration[i]);
    }
    Vector6 h;
    for (int i = kJoints; i-- > 0;) {
      h[i] = moment[i][2];
      const int parent = kTree[i].parent;
      if (parent < 0) continue;
      const Vector3d force = frames.R[i] * f[i];
      f[parent] += force;
      moment[parent] += frames.R[i] * moment[i] + frames.p[i].cross(force);
    }
    return h;
  }

  std::array<SpatialInertia, kJoints> body_;
  std::array<Matrix3d, kJoints> twist_;
  std::array<Vector3d, kJoints> offset_;
  Matrix63 C_;
  Vector6 q0_;
};

}  // namespace

void add_textbook(Engines& engines) {
  Engine engine;
  engine.name = "textbook route in Eigen (composite body, Newton-Euler, C)";
  const TextbookRobot robot;
  engine.forward = [robot](const State& state, Triple& psidd) { robot.forward(state, psidd); };
  engine.mass = [robot](const State& state, MassMatrix& M) { robot.mass_matrix(state, M); };
  engines.push_back(std::move(engine));
}

}  // namespace mixloop::bench
