// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/derivative.hpp"

#include <algorithm>

#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

Partials partials(const Graph& graph, NodeId id) {
  const ExpressionNode n = graph[id];
  return operation(n.op).partials(Expression::of(n.a), Expression::of(n.b), Expression::of(id));
}

// As needed(), no farther than the last of the outputs and inputs: a graph may have grown far past them.
std::vector<bool> needed_with(const Graph& graph, std::span<const NodeId> outputs,
                              std::span<const NodeId> inputs) {
  NodeId last = 0;
  for (const auto& nodes : {outputs, inputs})
    for (NodeId node : nodes) last = std::max(last, node);
  return needed(graph, outputs, last + 1);
}

}  // namespace

std::vector<NodeId> tangents(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                             std::span<const NodeId> seeds) {
  Recording recording(graph);
  const std::vector<bool> is_needed = needed_with(graph, outputs, inputs);
  std::vector<Expression> dot(is_needed.size());
  std::vector<bool> is_input(is_needed.size(), false);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    dot[inputs[i]] = Expression::of(seeds[i]);
    is_input[inputs[i]] = true;
  }
  auto moves = [&](NodeId id) { return !dot[id].is_number() || dot[id].number() != 0.0; };
  for (NodeId id = 0; id < is_needed.size(); ++id) {
    const ExpressionNode n = graph[id];
    const Operands operands(n);
    if (!is_needed[id] || is_input[id] || std::none_of(operands.begin(), operands.end(), moves)) continue;
    const Partials d = partials(graph, id);
    const Expression* slope = d.data();
    for (NodeId x : operands) {
      if (moves(x)) dot[id] += *slope * dot[x];
      ++slope;
    }
  }
  std::vector<NodeId> result;
  for (NodeId output : outputs) result.push_back(dot[output].node());
  return result;
}

std::vector<NodeId> gradient(Graph& graph, NodeId output, std::span<const NodeId> inputs) {
  Recording recording(graph);
  const std::vector<NodeId> outputs{output};
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<bool> moves(is_needed.size(), false), is_input(is_needed.size(), false);
  for (NodeId input : inputs) moves[input] = is_input[input] = true;
  for (NodeId id = 0; id < is_needed.size(); ++id) {
    const ExpressionNode n = graph[id];
    for (NodeId x : Operands(n))
      if (moves[x]) moves[id] = true;
  }
  std::vector<Expression> bar(is_needed.size());
  bar[output] = 1.0;
  for (NodeId id = output + 1; id-- > 0;) {
    const ExpressionNode n = graph[id];
    if (!is_needed[id] || !moves[id] || is_input[id] || is_leaf(n.op)) continue;
    if (bar[id].is_number() && bar[id].number() == 0.0) continue;
    const Partials d = partials(graph, id);
    const Expression* slope = d.data();
    for (NodeId x : Operands(n)) {
      if (moves[x]) bar[x] += bar[id] * *slope;
      ++slope;
    }
  }
  std::vector<NodeId> result;
  for (NodeId input : inputs) result.push_back(bar[input].node());
  return result;
}

std::vector<NodeId> substituted(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                                std::span<const NodeId> replacements) {
  const std::vector<bool> is_needed = needed_with(graph, outputs, inputs);
  std::vector<NodeId> now(is_needed.size());
  for (NodeId id = 0; id < is_needed.size(); ++id) now[id] = id;
  for (std::size_t i = 0; i < inputs.size(); ++i) now[inputs[i]] = replacements[i];
  for (NodeId id = 0; id < is_needed.size(); ++id) {
    const ExpressionNode n = graph[id];
    if (!is_needed[id] || is_leaf(n.op) || now[id] != id) continue;
    const Operands operands(n);
    if (std::all_of(operands.begin(), operands.end(), [&](NodeId x) { return now[x] == x; })) continue;
    now[id] = graph.operation(n.op, now[n.a], now[n.b], now[n.c]);
  }
  std::vector<NodeId> result;
  for (NodeId output : outputs) result.push_back(now[output]);
  return result;
}

}  // namespace mixloop
