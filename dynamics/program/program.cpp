// SPDX-License-Identifier: MIT
#include "dynamics/program/program.hpp"

#include <algorithm>
#include <map>

#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

namespace {

Program::Stage stage_of(const ExpressionNode& node, const std::vector<Program::Stage>& known) {
  using Stage = Program::Stage;
  if (node.op == Op::constant) return Stage::constant;
  if (node.op == Op::input)
    return static_cast<Block>(node.a) == Block::parameter ? Stage::set_up : Stage::run;
  Stage stage = Stage::constant;
  for (NodeId x : Operands(node)) stage = std::max(stage, known[x]);
  return stage;
}

}  // namespace

Program make_program(const Graph& graph, std::span<const NodeId> outputs) {
  Program program;
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<NodeId> now(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    if (!is_needed[id]) continue;
    ExpressionNode node = graph[id];
    if (node.op == Op::hold) {
      now[id] = now[node.a];
      continue;
    }
    NodeId* const operands[] = {&node.a, &node.b, &node.c};
    for (int i = 0; i < arity(node.op); ++i) *operands[i] = now[*operands[i]];
    now[id] = static_cast<NodeId>(program.nodes.size());
    program.stages.push_back(stage_of(node, program.stages));
    program.nodes.push_back(node);
  }
  for (NodeId output : outputs) program.outputs.push_back(now[output]);
  return program;
}

Program first_outputs(const Program& whole, std::size_t count) {
  std::vector<bool> needed(whole.nodes.size(), false);
  for (std::size_t i = 0; i < count; ++i) needed[whole.outputs[i]] = true;
  for (NodeId id = static_cast<NodeId>(whole.nodes.size()); id-- > 0;)
    if (needed[id])
      for (const NodeId operand : Operands(whole.nodes[id])) needed[operand] = true;
  Program part;
  std::vector<NodeId> place(whole.nodes.size());
  for (NodeId id = 0; id < whole.nodes.size(); ++id) {
    if (!needed[id]) continue;
    ExpressionNode node = whole.nodes[id];
    const auto taken = Operands(node);
    NodeId* const ids[] = {&node.a, &node.b, &node.c};
    for (std::size_t i = 0; i < static_cast<std::size_t>(taken.end() - taken.begin()); ++i)
      *ids[i] = place[taken.begin()[i]];
    place[id] = static_cast<NodeId>(part.nodes.size());
    part.nodes.push_back(node);
    part.stages.push_back(whole.stages[id]);
  }
  for (std::size_t i = 0; i < count; ++i) part.outputs.push_back(place[whole.outputs[i]]);
  return part;
}

OperationCount Program::operations(Stage stage) const {
  OperationCount count;
  const std::vector<NodeId> partner = partners();
  for (NodeId id = 0; id < nodes.size(); ++id) {
    if (stages[id] != stage) continue;
    const auto counter = operation(nodes[id].op).count;
    if (counter != nullptr && partner[id] > id) ++(count.*counter);  // a pair with its first
  }
  count.add += count.fused;
  count.mul += count.fused;
  return count;
}

std::vector<NodeId> Program::hoisted() const {
  std::vector<bool> used(nodes.size(), false);
  for (NodeId id = 0; id < nodes.size(); ++id) {
    if (stages[id] == Stage::run)
      for (NodeId x : Operands(nodes[id])) used[x] = true;
  }
  for (NodeId output : outputs) used[output] = true;
  std::vector<NodeId> result;
  for (NodeId id = 0; id < nodes.size(); ++id)
    if (used[id] && stages[id] == Stage::set_up) result.push_back(id);
  return result;
}

std::vector<NodeId> Program::partners() const {
  std::vector<NodeId> partner(nodes.size(), static_cast<NodeId>(nodes.size()));
  std::map<NodeId, NodeId> first;  // angle -> the earlier of its sine and cosine
  for (NodeId id = 0; id < nodes.size(); ++id) {
    if (nodes[id].op != Op::sin && nodes[id].op != Op::cos) continue;
    auto [known, fresh] = first.try_emplace(nodes[id].a, id);
    if (fresh) continue;
    partner[known->second] = id;
    partner[id] = known->second;
  }
  return partner;
}

double estimated_time(const OperationCount& count) {
  const auto times = [](std::size_t number, Op op) {
    return static_cast<double>(number) * operation(op).cost;
  };
  return times(count.add - count.fused, Op::add) + times(count.mul - count.fused, Op::mul) +
         times(count.fused, Op::fma) + times(count.div, Op::div) + times(count.sqrt, Op::sqrt) +
         times(count.sincos, Op::sin) + times(count.sincos, Op::cos) + times(count.other, Op::atan2);
}

}  // namespace mixloop
