// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/closed_chains.hpp"

#include "dynamics/procedure/constraints.hpp"
#include "dynamics/symbolic/block_solver.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

using E = Expression;

SolvedBlock ClosedChains::solve_block(const Model<E>& model, int block, AlongOnGraph& along) {
  if (model.scene->from_starts) {
    how_.push_back(BlockSolution::newton);
    return solve_by_newton(model, block, along);
  }
  if (auto single = solve_single(model, block, along)) {
    how_.push_back(BlockSolution::single);
    return std::move(*single);
  }
  if (auto dyad = solve_dyad(model, block, along)) {
    how_.push_back(BlockSolution::dyad);
    return std::move(*dyad);
  }
  if (auto distances = solve_three_distances(model, block, along)) {
    how_.push_back(BlockSolution::distances);
    return std::move(*distances);
  }
  if (!model.scene->blocks[static_cast<std::size_t>(block)].cut.empty()) {
    how_.push_back(BlockSolution::torn);
    return solve_torn(model, block, along);
  }
  how_.push_back(BlockSolution::newton);
  return solve_by_newton(model, block, along);
}

void ClosedChains::solve(const Model<E>& model, Workspace<E>& ws) {
  how_.clear(), corrections_.clear(), angles_.clear(), lengths_.clear();
  AlongOnGraph along(model, span_of(in_.psi), nullptr, in_.t, E(0.0), ws);
  for (const auto& step : model.scene->steps) {
    if (step.coordinate >= 0) {
      along.by_formula(step.coordinate);
      continue;
    }
    const SolvedBlock solved = solve_block(model, step.block, along);
    angles_.insert(angles_.end(), solved.angles.begin(), solved.angles.end());
    lengths_.insert(lengths_.end(), solved.lengths.begin(), solved.lengths.end());
    corrections_.insert(corrections_.end(), solved.corrections.begin(), solved.corrections.end());
    const Scene::Block& block = model.scene->blocks[static_cast<std::size_t>(step.block)];
    for (std::size_t i = 0; i < solved.x.size(); ++i) ws.x[block.unknowns[i]] = solved.x[i];
    ExpressionMatrix slopes;
    ExpressionVector values;
    along.linearise(block, slopes, values);
    ws.systems[static_cast<std::size_t>(step.block)] = SmallSystem<E>(slopes, solved.links);
    along.settle(block);
  }
}

std::vector<E> ClosedChains::solution(const Scene& scene, const Workspace<E>& ws) const {
  std::vector<E> numbers;
  for (int j : scene.started) {
    const E& x = ws.x[j];
    numbers.push_back(x);
    if (!scene.turns(j)) continue;
    numbers.push_back(cos(x));
    numbers.push_back(sin(x));
  }
  return numbers;
}

std::vector<E> ClosedChains::solved_from_start(const Model<E>& model, Workspace<E> ws) const {
  if (corrections_.empty()) return {};
  std::vector<E> solved = solution(*model.scene, ws);
  solved.insert(solved.end(), corrections_.begin(), corrections_.end());
  if (model.scene->started_rates() == 0) return solved;
  AlongOnGraph along(model, span_of(in_.psi), nullptr, in_.t, E(1.0), ws);
  along.work_out(false);
  for (int j : model.scene->started) {
    for (int i = 0; i < model.n(); ++i) solved.push_back(ws.C(j, i));
    solved.push_back(along.along(j).d);
  }
  return solved;
}

std::vector<E> ClosedChains::stretches() const {
  std::vector<E> stretches;
  for (const Angle& angle : angles_)
    stretches.push_back(E(0.5) * ((angle.cosine * angle.cosine - E(1.0)) + angle.sine * angle.sine));
  return stretches;
}

std::vector<Cut> ClosedChains::cuts(const Workspace<E>& ws) const {
  std::vector<Cut> cuts;
  const auto slopes_of = [&](const WholeSum& of) {
    ExpressionVector slopes = ExpressionVector::Constant(ws.C.cols(), E(0.0));
    for (const auto& [coordinate, multiple] : of) slopes += ws.C.row(coordinate).transpose() * E(multiple);
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
      known_.push_back(apply(n.op, known_[n.a], known_[n.b], known_[n.c]));
  }
  return known_[node];
}

double HomeValues::input(Block block, std::size_t index) const {
  if (block == Block::psi) return scene_.home[index];
  if (block == Block::parameter) return scene_.default_parameters()[index];
  if (block != Block::start) return 0;
  for (int j : scene_.started) {
    const double home = scene_.coordinates[static_cast<std::size_t>(j)].home;
    const std::size_t size = scene_.turns(j) ? 3 : 1;
    if (index < size)
      return index == 0 ? home : index == 1 ? mixloop_functions::cos(home) : mixloop_functions::sin(home);
    index -= size;
  }
  return 0;
}

ClosureStart start_of(const Scene& scene, int coordinate) {
  std::size_t index = 0;
  bool found = false;
  for (int j : scene.started) {
    found = j == coordinate;
    if (found) break;
    index += scene.turns(j) ? 3 : 1;
  }
  if (!found) index = kNoStart;
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

ClosedCoordinates::ClosedCoordinates(const std::shared_ptr<const Scene>& scene)
    : in_(*scene),
      model_(make_model<E>(scene, std::span<const E>(in_.parameters))),
      ws_(model_),
      chains_(in_) {
  ws_.solve = [this](const auto&, auto, const auto&, auto& ws) { chains_.solve(model_, ws); };
  mixloop::coordinates<E>(model_, span_of(in_.psi), in_.t, ws_);
  AlongOnGraph(model_, span_of(in_.psi), nullptr, in_.t, E(1.0), ws_).work_out(false);
  for (const auto& along : ws_.along) by_time_.push_back(along.d);
}

std::vector<E> ClosedCoordinates::rows() {
  AlongOnGraph along(model_, span_of(in_.psi), nullptr, in_.t, E(0.0), ws_);
  std::vector<Scene::ClosureRow> all;
  for (std::size_t c = 0; c < model_.scene->closures.size(); ++c)
    for (int r = 0; r < model_.scene->closures[c].rows(); ++r) all.push_back({static_cast<int>(c), r});
  std::vector<E> values;
  for (const auto& row : along.rows_of(all)) values.push_back(row.v);
  return values;
}

std::vector<int> ClosedCoordinates::cut(int block) {
  AlongOnGraph along(model_, span_of(in_.psi), nullptr, in_.t, E(0.0), ws_);
  return cut_of(model_, block, slopes(model_.scene->blocks[static_cast<std::size_t>(block)]), along);
}

ExpressionMatrix ClosedCoordinates::slopes(const Scene::Block& block) {
  AlongOnGraph along(model_, span_of(in_.psi), nullptr, in_.t, E(0.0), ws_);
  ExpressionMatrix slopes;
  ExpressionVector values;
  along.linearise(block, slopes, values);
  along.settle(block);
  return slopes;
}

}  // namespace mixloop
