// SPDX-License-Identifier: MIT
#include "dynamics/program/trace.hpp"

#include <stdexcept>

#include "dynamics/program/short_chains.hpp"
#include "dynamics/symbolic/closed_chains.hpp"
#include "dynamics/symbolic/derivative.hpp"
#include "dynamics/symbolic/operations.hpp"
#include "dynamics/symbolic/tracer.hpp"

namespace mixloop {
namespace {

using Nodes = std::vector<NodeId>;

template <class Derived>
void append(Nodes& nodes, const Eigen::MatrixBase<Derived>& values) {
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i) nodes.push_back(values(i, j).node());
}

ExpressionVector input_vector(int from, int n) {
  ExpressionVector result(n);
  for (int i = 0; i < n; ++i) result[i] = Expression::input(Block::input, static_cast<std::size_t>(from + i));
  return result;
}

// What the motors' forces are to all independent coordinates, n: along psi, or C^T tau of those along a
// coordinate.
ExpressionVector driving_forces(const Scene& scene, Tracer& tracer) {
  if (scene.acts_along.empty()) return motor_inputs(scene);
  ExpressionVector forces = ExpressionVector::Constant(scene.n(), Expression(0.0));
  for (std::size_t motor = 0; motor < scene.acts_along.size(); ++motor) {
    const Expression tau = Expression::input(Block::input, motor);
    if (scene.acts_along[motor] < 0)
      forces[static_cast<Eigen::Index>(motor)] += tau;
    else
      forces += tracer.slopes(scene.acts_along[motor]) * tau;
  }
  return forces;
}

// psidd = M^-1 (tau - h) satisfies r = M psidd + h - tau = 0, so d psidd = -M^-1 dr at fixed psidd.
Nodes linearisation(Graph& graph, const Scene& scene, Tracer& tracer) {
  if (!scene.acts_along.empty()) throw std::logic_error("a linearisation where motors act along coordinates");
  const int n = scene.n();
  const TracedInputs in(scene);
  const ExpressionVector held = input_vector(n, n);  // stands for psidd while r is differentiated
  Nodes residual, stand_ins, psidd;
  append(residual, tracer.inverse_dynamics(held));
  append(stand_ins, held);
  append(psidd, tracer.forward_dynamics(motor_inputs(scene)));
  Nodes outputs;
  const std::vector<Cut> cuts = tracer.cuts();
  for (const ExpressionVector* x : {&in.psi, &in.psid}) {
    ExpressionMatrix B(n, n);
    for (int j = 0; j < n; ++j) {
      Nodes inputs{(*x)[j].node()}, seeds{graph.one()};
      if (x == &in.psi)
        for (const Cut& cut : cuts) inputs.push_back(cut.node), seeds.push_back(cut.slopes[j].node());
      const Nodes d = tangents(graph, residual, inputs, seeds);
      const Nodes at_psidd = substituted(graph, d, stand_ins, psidd);
      for (int i = 0; i < n; ++i) B(i, j) = -Expression::of(at_psidd[static_cast<std::size_t>(i)]);
    }
    append(outputs, tracer.mass_inverse_times(B));
  }
  append(outputs, tracer.mass_inverse_times(ExpressionMatrix::Identity(n, scene.n_u())));
  return outputs;
}

// What a purpose gives, without what its closures' solution does.
Nodes outputs_of(Graph& graph, const std::shared_ptr<const Scene>& scene, Purpose purpose, Tracer& tracer) {
  const int n = scene->n(), n_u = scene->n_u();
  Nodes nodes;
  switch (purpose) {
    case Purpose::forward_dynamics:
      append(nodes, tracer.forward_dynamics(driving_forces(*scene, tracer)));
      break;
    case Purpose::mass_times:
      append(nodes, tracer.mass_times(motor_inputs(*scene)).head(n_u));
      break;
    case Purpose::mass_matrix:
      append(nodes, tracer.mass_matrix());
      break;
    case Purpose::bias:
      append(nodes, tracer.bias());
      break;
    case Purpose::inverse_dynamics:
      append(nodes, tracer.inverse_dynamics(input_vector(0, n)));
      break;
    case Purpose::linearisation:
      return linearisation(graph, *scene, tracer);
    case Purpose::energy: {
      const Energy<Expression> energy = tracer.energy();
      nodes = {energy.kinetic.node(), energy.potential.node()};
      break;
    }
    case Purpose::end_effector: {
      std::vector<Expression> solved;
      const auto state = trace_end_effector(scene, input_vector(0, n), solved);
      append(nodes, state.position), append(nodes, state.velocity), append(nodes, state.acceleration);
      append(nodes, state.jacobian);
      for (const Expression& number : solved) nodes.push_back(number.node());
      break;
    }
    case Purpose::dynamics_and_mass_times:
      append(nodes, tracer.forward_dynamics(driving_forces(*scene, tracer)));
      append(nodes, tracer.mass_times(motor_inputs(*scene, n_u)).head(n_u));
      break;
  }
  return nodes;
}

std::unique_ptr<Tracer> make_tracer(const std::shared_ptr<const Scene>& scene, Tracing tracing) {
  switch (tracing) {
    case Tracing::recursive:
      return recursive_tracer(scene);
    case Tracing::articulated:
      return articulated_tracer(scene);
    case Tracing::harmonic:
      return harmonic_tracer(scene);
    case Tracing::inertial:
      return inertial_tracer(scene);
    default:
      return literal_tracer(scene);
  }
}

// Starts stand behind what the purpose's input takes.
Program started_behind(Program program, const Scene& scene, int behind) {
  for (ExpressionNode& node : program.nodes) {
    if (node.op != Op::input || static_cast<Block>(node.a) != Block::start) continue;
    if (node.b >= static_cast<NodeId>(scene.start_size()))
      throw std::logic_error("a program needs the start of a coordinate that has none");
    node.a = static_cast<NodeId>(Block::input);
    node.b += static_cast<NodeId>(behind);
  }
  return program;
}

}  // namespace

Program trace(const std::shared_ptr<const Scene>& scene, Purpose purpose, Tracing tracing) {
  if (tracing == Tracing::articulated && !signature(purpose).gives_psidd) return {};  // as the recursive one
  try {
    // A linearisation, which nothing stands in for, may take more.
    Graph graph(purpose == Purpose::linearisation ? kMostOfDerivatives : Graph::kMostNodes);
    const Recording recording(graph);
    const auto tracer = make_tracer(scene, tracing);
    if (!tracer) return {};
    Nodes outputs = outputs_of(graph, scene, purpose, *tracer);
    for (const Expression& number : tracer->solved_from_start()) outputs.push_back(number.node());
    const int behind = signature(purpose).input_size(scene->n(), scene->n_u());
    return started_behind(with_short_chains(make_program(graph, outputs)), *scene, behind);
  } catch (const GraphFull&) {
    return {};
  }
}

namespace {

// The literal procedure's Jacobians take m columns a body: on larger scenes it is not worth recording.
constexpr int kMostComposite = 16;

bool is_small(const Scene& scene) { return scene.transforms.size() <= 8; }

}  // namespace

TracedProgram trace(const std::shared_ptr<const Scene>& scene, Purpose purpose) {
  if (purpose == Purpose::end_effector) return {trace(scene, purpose, Tracing::literal), Tracing::literal};
  TracedProgram best;
  for (Tracing tracing :
       {Tracing::articulated, Tracing::recursive, Tracing::harmonic, Tracing::inertial, Tracing::literal}) {
    if (tracing == Tracing::literal && !is_small(*scene)) continue;
    // Composite bodies take the square of n and more: articulated ones, where they serve, are ahead by far.
    if (tracing == Tracing::recursive && scene->n() > kMostComposite && !best.program.outputs.empty())
      continue;
    Program found = trace(scene, purpose, tracing);
    if (found.outputs.empty()) continue;
    if (best.program.outputs.empty() ||
        estimated_time(found.run_operations()) < estimated_time(best.program.run_operations()))
      best = {std::move(found), tracing};
  }
  return best;
}

}  // namespace mixloop

namespace mixloop {
namespace {

// |G| |G^-1| / k of a block's slopes, scaled: of a torn one by the inverse that it has been solved with.
Expression condition_of(const Scene& scene, const Scene::Block& block, const ExpressionMatrix& slopes,
                        const SmallSystem<Expression>& unscaled) {
  const auto k = slopes.rows();
  ExpressionMatrix scaled = slopes;
  ExpressionVector of_row = ExpressionVector::Constant(k, Expression(1.0)), of_unknown = of_row;
  for (Eigen::Index i = 0; i < k; ++i) {
    if (scene.is_length(block.rows[static_cast<std::size_t>(i)])) of_row[i] = Expression(1 / scene.size);
    if (!scene.turns(block.unknowns[static_cast<std::size_t>(i)])) of_unknown[i] = Expression(scene.size);
    scaled.row(i) *= of_row[i];
    scaled.col(i) *= of_unknown[i];
  }
  const bool is_torn = !block.cut.empty();
  const SmallSystem<Expression> system = is_torn ? unscaled : SmallSystem<Expression>(scaled);
  Expression all = 0.0, inverse = 0.0;
  for (Eigen::Index j = 0; j < k; ++j) {
    ExpressionVector unit = ExpressionVector::Constant(k, Expression(0.0));
    unit[j] = is_torn ? Expression(1.0) / of_row[j] : Expression(1.0);
    ExpressionVector column = system.solve(unit);
    if (is_torn) column = column.cwiseQuotient(of_unknown);
    inverse += column.dot(column);
    all += scaled.col(j).dot(scaled.col(j));
  }
  return sqrt(all * inverse) * Expression(1.0 / static_cast<double>(k));
}

}  // namespace

Program trace_closures(const std::shared_ptr<const Scene>& scene) try {
  Graph graph;
  const Recording recording(graph);
  ClosedCoordinates closed(scene);
  std::vector<Expression> numbers;
  for (int j : scene->started) {
    for (int i = 0; i < scene->n(); ++i) numbers.push_back(closed.C()(j, i));
    numbers.push_back(closed.by_time(j));
  }
  for (const Expression& row : closed.rows()) numbers.push_back(row);
  for (const Expression& pair : closed.stretches()) numbers.push_back(pair);
  for (std::size_t b = 0; b < scene->blocks.size(); ++b)
    numbers.push_back(
        condition_of(*scene, scene->blocks[b], closed.slopes(scene->blocks[b]), closed.system(b)));
  for (const Expression& number : closed.solution()) numbers.push_back(number);
  for (const Expression& number : closed.corrections()) numbers.push_back(number);
  Nodes outputs;
  for (const Expression& number : numbers) outputs.push_back(number.node());
  // Not simplified as one whole: what is watched is the solution as it came out.
  return started_behind(make_program(graph, outputs), *scene, 0);
} catch (const GraphFull&) {
  return {};
}

}  // namespace mixloop
