// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "dynamics/procedure/constraints.hpp"
#include "dynamics/scene/scene.hpp"
#include "dynamics/symbolic/expression.hpp"

namespace mixloop {

using ExpressionVector = Vec<Expression>;
using ExpressionMatrix = Mat<Expression>;

// Compiled once, in literal.cpp.
extern template class SmallSystem<Expression>;
extern template struct Workspace<Expression>;
extern template class detail::CoordinatesAlong<Expression>;
extern template Model<Expression> make_model(const std::shared_ptr<const Scene>&,
                                             std::span<const Expression>);
extern template void coordinates(const Model<Expression>&, std::span<const Expression>, const Expression&,
                                 Workspace<Expression>&);

/// A scene's inputs as expressions of the recording graph.
struct TracedInputs {
  explicit TracedInputs(const Scene& scene);

  ExpressionVector psi, psid;
  Expression t;
  std::vector<Expression> parameters;
};

/// What the motors' inputs from `from` on are to all independent coordinates, n: nothing on those without
/// one.
ExpressionVector motor_inputs(const Scene& scene, int from = 0);

/// A node that closures are solved for, with its derivatives by psi (n): where differentiating stops.
struct Cut {
  NodeId node;
  ExpressionVector slopes;
};

/// A way to write down a scene's equations of motion on the expression scalar. Each is exact; they differ
/// in how many operations they leave. Used while a Recording lives.
class Tracer {
 public:
  virtual ~Tracer() = default;

  virtual ExpressionMatrix mass_matrix() = 0;
  virtual ExpressionVector bias() = 0;
  virtual Energy<Expression> energy() = 0;
  virtual ExpressionVector mass_times(const ExpressionVector& a);
  virtual ExpressionVector inverse_dynamics(const ExpressionVector& psidd);
  virtual ExpressionVector forward_dynamics(const ExpressionVector& tau);
  /// M^-1 B, column by column.
  virtual ExpressionMatrix mass_inverse_times(const ExpressionMatrix& B);

  /// d q_j / d psi, n: how a force along a coordinate is shared out. Of scenes whose chains close.
  virtual ExpressionVector slopes(int coordinate);
  /// Of what has been written down so far: what closures are solved for.
  virtual std::vector<Cut> cuts() const { return {}; }
  /// Where closures are solved by Newton's method: the solution, a start for what comes next (start_size()),
  /// and the last corrections (rad or m); where a block is torn, the started coordinates' derivatives by psi
  /// and t, too (started_rates()).
  virtual std::vector<Expression> solved_from_start() const { return {}; }
};

/// Records the procedure as it stands: works for every scene.
std::unique_ptr<Tracer> literal_tracer(std::shared_ptr<const Scene> scene);

/// Composite bodies and Newton-Euler in link frames, then C: far fewer operations on long chains.
std::unique_ptr<Tracer> recursive_tracer(std::shared_ptr<const Scene> scene);

/// Newton and Euler along C in inertial axes: the fewest operations where links that turn in one plane close
/// a loop. nullptr where no chain closes.
std::unique_ptr<Tracer> inertial_tracer(std::shared_ptr<const Scene> scene);

/// Articulated bodies in link frames for forward dynamics, operations in proportion to n; the rest as the
/// recursive tracer. nullptr unless each independent coordinate moves one joint of the tree alone, and the
/// motors act along these.
std::unique_ptr<Tracer> articulated_tracer(std::shared_ptr<const Scene> scene);

/// Kinetic energy and potential as trigonometric polynomials of the independent angles. nullptr where the
/// scene is none of that kind, or would take more terms than the budget.
std::unique_ptr<Tracer> harmonic_tracer(std::shared_ptr<const Scene> scene);

/// The end effector's state, recorded from the procedure, and `solved` as Tracer::solved_from_start.
EndEffectorState<Expression> trace_end_effector(std::shared_ptr<const Scene> scene,
                                                const ExpressionVector& psidd,
                                                std::vector<Expression>& solved);

}  // namespace mixloop
