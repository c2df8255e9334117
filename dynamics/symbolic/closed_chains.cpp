// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/closed_chains.hpp"

#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

using E = Expression;

void ClosedChains::solve(const Model<E>& model, Workspace<E>& ws) {
  how_.clear(), corrections_.clear(), angles_.clear(), lengths_.clear();
  AlongOnGraph along(model, span_of(in_.psi), nullptr, in_.t, E(0.0), ws);
  for (const auto& step : model.scene->steps) {
    if (step.coordinate >= 0) {
      along.by_formula(step.coordinate);
      continue;
    }
    auto dyad = solve_dyad(model, step.block, along);
    const SolvedBlock solved = dyad ? std::move(*dyad) : solve_by_newton(model, step.block, along);
    how_.push_back(dyad ? BlockSolution::dyad : BlockSolution::newton);
    angles_.insert(angles_.end(), solved.angles.begin(), solved.angles.end());
    lengths_.insert(lengths_.end(), solved.lengths.begin(), solved.lengths.end());
    corrections_.insert(corrections_.end(), solved.corrections.begin(), solved.corrections.end());
    const Scene::Block& block = model.scene->blocks[static_cast<std::size_t>(step.block)];
    for (std::size_t i = 0; i < solved.x.size(); ++i) ws.x[block.unknowns[i]] = solved.x[i];
    ExpressionMatrix slopes;
    ExpressionVector values;
    along.linearise(block, slopes, values);
    ws.systems[static_cast<std::size_t>(step.block)] = SmallSystem<E>(slopes);
    along.settle(block);
  }
}

std::vector<Cut> ClosedChains::cuts(const Workspace<E>& ws) const {
  std::vector<Cut> cuts;
  const auto slopes_of = [&](const WholeSum& of) {
    ExpressionVector slopes = ExpressionVector::Constant(ws.C.cols(), E(0.0));
    for (const auto& [coordinate, multiple] : of)
      slopes += ws.C.row(coordinate).transpose() * E(multiple);
    return slopes;
  };
  for (const Angle& angle : angles_) {
    const ExpressionVector slopes = slopes_of(angle.of);
    cuts.push_back({angle.angle.node(), slopes});
    cuts.push_back({angle.cosine.node(), slopes * -angle.sine});
    cuts.push_back({angle.sine.node(), slopes * angle.cosine});
  }
  for (const Length& length : lengths_) cuts.push_back({length.length.node(), slopes_of({{length.of, 1}})});
  return cuts;
}

double HomeValues::of(const Expression& x) {
  if (x.is_number()) return x.number();
  const Graph& graph = recording_graph();
  const NodeId node = x.node();
  for (NodeId id = static_cast<NodeId>(known_.size()); id <= node; ++id) {
    const ExpressionNode& n = graph[id];
    if (n.op == Op::constant)
      known_.push_back(n.value);
    else if (n.op == Op::input)
      known_.push_back(input(static_cast<Block>(n.a), n.b));
    else
      known_.push_back(apply(n.op, known_[n.a], is_binary(n.op) ? known_[n.b] : 0.0));
  }
  return known_[node];
}

double HomeValues::input(Block block, std::size_t index) const {
  if (block == Block::psi) return scene_.home[index];
  if (block == Block::parameter) return scene_.default_parameters()[index];
  if (block != Block::start) return 0;
  for (int j = 0; j < scene_.m(); ++j) {
    const auto& coordinate = scene_.coordinates[static_cast<std::size_t>(j)];
    if (!coordinate.is_solved()) continue;
    const std::size_t size = scene_.turns(j) ? 3 : 1;
    if (index < size)
      return index == 0 ? coordinate.home : index == 1 ? std::cos(coordinate.home) : std::sin(coordinate.home);
    index -= size;
  }
  return 0;
}

ClosureStart start_of(const Scene& scene, int coordinate) {
  std::size_t index = 0;
  for (int j = 0; j < coordinate; ++j)
    if (scene.coordinates[static_cast<std::size_t>(j)].is_solved()) index += scene.turns(j) ? 3 : 1;
  const auto input = [&](std::size_t i) { return E::input(Block::start, index + i); };
  if (!scene.turns(coordinate)) return {input(0)};
  ClosureStart start{E::held(input(0), 0), E::held(input(1), 0), E::held(input(2), 0)};
  recording_graph().set_pair(start.value.node(), start.cosine.node(), start.sine.node());
  return start;
}

ClosedChains::Angle held_angle(const WholeSum& of, const Planar& direction, const E& about, unsigned tag) {
  const E c = E::held(direction.x, tag), s = E::held(direction.y, tag);
  const E c_about = cos(about), s_about = sin(about);
  const E angle = E::held(about + atan2(s * c_about - c * s_about, c * c_about + s * s_about), tag);
  recording_graph().set_pair(angle.node(), c.node(), s.node());
  return {of, angle, c, s};
}

}  // namespace mixloop
