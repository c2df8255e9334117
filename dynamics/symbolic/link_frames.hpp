// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/procedure/line_loads.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {

using Expression3 = Vec3<Expression>;
using Expression33 = Mat3<Expression>;

inline Expression3 cross(const Expression3& a, const Expression3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Expression3 zero3() { return {Expression(0.0), Expression(0.0), Expression(0.0)}; }

/// A rotation about one axis, by its cosine and sine.
struct Turn {
  Expression c, s;

  Expression3 into_z(const Expression3& x) const { return {c * x[0] + s * x[1], c * x[1] - s * x[0], x[2]}; }
  Expression3 back_z(const Expression3& x) const { return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]}; }
  Expression3 into_x(const Expression3& x) const { return {x[0], c * x[1] + s * x[2], c * x[2] - s * x[1]}; }
  Expression3 back_x(const Expression3& x) const { return {x[0], c * x[1] - s * x[2], s * x[1] + c * x[2]}; }

  // R I R^T of a symmetric I, column by column and row by row.
  Expression33 back_x(const Expression33& I) const {
    return both(I, [&](const Expression3& x) { return back_x(x); });
  }
  Expression33 back_z(const Expression33& I) const {
    return both(I, [&](const Expression3& x) { return back_z(x); });
  }

 private:
  template <class Rotate>
  static Expression33 both(const Expression33& I, Rotate rotate) {
    Expression33 half, whole;
    for (Eigen::Index j = 0; j < 3; ++j) half.col(j) = rotate(Expression3(I.col(j)));
    for (Eigen::Index i = 0; i < 3; ++i)
      whole.row(i) = rotate(Expression3(half.row(i).transpose())).transpose();
    for (Eigen::Index i = 0; i < 3; ++i)
      for (Eigen::Index j = 0; j < i; ++j) whole(i, j) = whole(j, i);
    return whole;
  }
};

/// Mass, first moment and inertia of a rigid body about a frame's origin, in its axes.
struct Inertia {
  Expression mass = 0.0;
  Expression3 moment = zero3();
  Expression33 tensor = Expression33::Constant(Expression(0.0));

  Inertia& operator+=(const Inertia& other) {
    mass += other.mass;
    moment += other.moment;
    tensor += other.tensor;
    return *this;
  }
};

/// The tensor that a mass at r brings is m (r.r E - r r^T); `moment` is m r.
Expression33 parallel_axis(const Expression3& r, const Expression3& moment);

struct Wrench {
  Expression3 force = zero3(), moment = zero3();
};

/// A scene's frames and bodies on the expression scalar, with the recursions' steps from frame to frame.
///
/// A transform turns about z by theta into the frame "mid", where the way to the next origin is
/// (a, 0, s) whatever the angle is, then about x by the constant alpha. Link i makes frame i + 1.
class LinkFrames {
 public:
  struct Link {
    Turn theta, alpha;
    Expression3 way;  ///< (a, 0, s): from the parent's origin to this frame's, in mid
    bool moves = false;
  };

  explicit LinkFrames(const std::shared_ptr<const Scene>& scene);

  const TracedInputs& inputs() const { return in_; }
  const Model<Expression>& model() const { return model_; }
  /// q, qd and q_bias (m) and C (m x n).
  const Workspace<Expression>& coordinates() const { return workspace_; }

  /// What closures are solved for.
  const ClosedChains& chains() const { return *chains_; }

  std::size_t size() const { return links_.size(); }
  const Link& operator[](std::size_t i) const { return links_[i]; }
  std::size_t parent(std::size_t i) const { return static_cast<std::size_t>(model_.links[i].parent); }
  bool prismatic(std::size_t i) const { return model_.links[i].prismatic; }
  int coordinate(std::size_t i) const { return model_.links[i].coordinate; }
  const Expression& scale(std::size_t i) const { return model_.links[i].scale; }
  /// Of each frame; what hangs on a fixed transform is with the frame that carries it.
  const std::vector<Inertia>& inertias() const { return inertias_; }

  /// What a frame's inertia is to its parent: in the axes of mid, about the parent's origin.
  Inertia in_mid(std::size_t i, const Inertia& own) const;
  /// The same in the parent's axes.
  Inertia in_parent(std::size_t i, const Inertia& mid) const;
  /// A wrench on a frame, at the parent's origin in mid.
  Wrench in_mid(std::size_t i, const Wrench& own) const;
  Wrench in_parent(std::size_t i, const Wrench& mid) const;
  /// A vector in inertial axes, in a frame's.
  Expression3 in_frame(int frame, Expression3 x) const;
  /// Adds what springs and dampers at coordinates, along formulas and between points take: along the
  /// coordinates (m), and along the independent ones directly (n).
  void add_spring_dampers(ExpressionVector& on_q, ExpressionVector& on_psi) const;
  Expression spring_potentials() const;
  LineState<Expression> line_state() const;
  /// Takes the external loads off the frames' wrenches.
  void subtract_loads(std::vector<Wrench>& wrench) const;

 private:
  void place_links();
  void lump_bodies();

  TracedInputs in_;
  Model<Expression> model_;
  Workspace<Expression> workspace_;
  std::shared_ptr<ClosedChains> chains_;
  std::vector<Link> links_;
  std::vector<Inertia> inertias_;
};

}  // namespace mixloop
