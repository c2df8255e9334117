// SPDX-License-Identifier: MIT
// The cheapest way of writing down the equations of motion of a harmonic energy.
#include <limits>

#include "dynamics/symbolic/harmonic_equations.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

bool is_sum(Op op) { return op == Op::add || op == Op::sub; }

// What the outputs take in a run: each sum takes in a product that nothing else needs.
double cost_of(const Graph& graph, std::span<const NodeId> outputs) {
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<bool> runs(graph.size(), false);
  std::vector<int> uses(graph.size(), 0);
  for (NodeId output : outputs) ++uses[output];
  for (NodeId id = 0; id < graph.size(); ++id)
    if (is_needed[id])
      for (NodeId x : Operands(graph[id])) ++uses[x];
  const auto is_taken_in = [&](NodeId id) { return graph[id].op == Op::mul && uses[id] == 1 && runs[id]; };
  double cost = 0;
  for (NodeId id = 0; id < graph.size(); ++id) {
    const ExpressionNode& node = graph[id];
    if (node.op == Op::input) runs[id] = static_cast<Block>(node.a) != Block::parameter;
    for (NodeId x : Operands(node))
      if (runs[x]) runs[id] = true;
    if (!is_needed[id] || !runs[id]) continue;
    cost += operation(node.op).cost;
    if (is_sum(node.op) && (is_taken_in(node.a) || is_taken_in(node.b))) cost -= operation(Op::mul).cost;
  }
  return cost;
}

// Tries a few ways of writing forward dynamics down, each in a graph of its own: bases, then for each
// angle the phase, then the schemes, one after the other.
class WritingSearch {
 public:
  WritingSearch(const Scene& scene, std::shared_ptr<const HarmonicScene> found)
      : scene_(scene), found_(std::move(found)) {}

  Writing best() {
    Writing best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t basis = 0; basis < found_->forms.size(); ++basis) {
      Writing now;
      now.basis = basis;
      now.phase.assign(found_->angles.angles.size(), 0);
      double cost = cost_of_writing(now);
      if (cost > 1.3 * least) continue;
      for (double before = 2 * cost; cost < before;) {
        before = cost;
        cost = improve(now, cost);
      }
      if (cost < least) best = now, least = cost;
    }
    return best;
  }

 private:
  double improve(Writing& now, double cost) const {
    const auto attempt = [&](const Writing& other) {
      const double found = cost_of_writing(other);
      if (found < cost) now = other, cost = found;
    };
    for (std::size_t e = 0; e < now.phase.size(); ++e) {
      for (std::size_t p = 0; p < found_->angles.phases[e].size(); ++p) {
        Writing other = now;
        other.phase[e] = p;
        if (p != now.phase[e]) attempt(other);
      }
    }
    for (bool Writing::*choice : {&Writing::reverse_gradient, &Writing::squared_sine, &Writing::collected}) {
      Writing other = now;
      other.*choice = !(now.*choice);
      attempt(other);
    }
    return cost;
  }

  double cost_of_writing(const Writing& writing) const {
    Graph graph;
    const Recording recording(graph);
    std::vector<Expression> atoms;
    for (std::size_t i = 0; i < found_->energy.atoms.size(); ++i)
      atoms.push_back(Expression::input(Block::parameter, i));
    const auto tracer = harmonic_equations(scene_, found_, writing, atoms);
    std::vector<NodeId> outputs;
    for (const Expression& x : tracer->forward_dynamics(motor_inputs(scene_))) outputs.push_back(x.node());
    return cost_of(graph, outputs);
  }

  const Scene& scene_;
  std::shared_ptr<const HarmonicScene> found_;
};

constexpr std::size_t kBasesTried = 8;

}  // namespace

std::unique_ptr<Tracer> harmonic_tracer(std::shared_ptr<const Scene> scene) {
  if (scene->is_closed()) return nullptr;
  auto energy = harmonic_energy(scene, recording_graph());
  if (!energy) return nullptr;
  auto found = std::make_shared<HarmonicScene>();
  found->energy = std::move(*energy);
  auto angles = evaluation_angles(found->energy);
  if (!angles) return nullptr;
  found->angles = std::move(*angles);
  for (const Eigen::MatrixXd& B : candidate_bases(found->energy, kBasesTried))
    found->forms.push_back(block_form(found->energy, B));
  const Writing writing = WritingSearch(*scene, found).best();
  const std::vector<Expression> atoms = found->energy.atoms;
  return harmonic_equations(*scene, std::move(found), writing, atoms);
}

}  // namespace mixloop
