// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/derivative.hpp"

#include "dynamics/symbolic/expression.hpp"

namespace mixloop {
namespace {

// d op(a, b) / da and / db.
struct Partials {
  Expression a, b;
};

Partials partials_of_unary(Op op, const Expression& x, const Expression& y) {
  switch (op) {
    case Op::neg:
      return {-1.0, 0.0};
    case Op::sqrt:
      return {0.5 / y, 0.0};
    case Op::sin:
      return {cos(x), 0.0};
    case Op::cos:
      return {-sin(x), 0.0};
    case Op::exp:
      return {y, 0.0};
    case Op::log:
      return {1.0 / x, 0.0};
    default:
      return {0.0, 0.0};
  }
}

Partials partials(const Graph& graph, NodeId id) {
  const ExpressionNode n = graph[id];
  const Expression a = Expression::of(n.a), y = Expression::of(id);
  if (!is_binary(n.op)) return partials_of_unary(n.op, a, y);
  const Expression b = Expression::of(n.b);
  switch (n.op) {
    case Op::add:
      return {1.0, 1.0};
    case Op::sub:
      return {1.0, -1.0};
    case Op::mul:
      return {b, a};
    case Op::div:
      return {1.0 / b, -y / b};
    case Op::atan2:
      return {b / (a * a + b * b), -a / (a * a + b * b)};
    default:
      return {0.0, 0.0};
  }
}

bool is_leaf(const ExpressionNode& n) { return n.op == Op::constant || n.op == Op::input; }

}  // namespace

std::vector<NodeId> tangents(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                             std::span<const NodeId> seeds) {
  Recording recording(graph);
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<Expression> dot(is_needed.size());
  std::vector<bool> is_input(is_needed.size(), false);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    dot[inputs[i]] = Expression::of(seeds[i]);
    is_input[inputs[i]] = true;
  }
  auto moves = [&](NodeId id) { return !dot[id].is_number() || dot[id].number() != 0.0; };
  for (NodeId id = 0; id < is_needed.size(); ++id) {
    const ExpressionNode n = graph[id];
    if (!is_needed[id] || is_input[id] || is_leaf(n)) continue;
    const bool by_a = moves(n.a), by_b = is_binary(n.op) && moves(n.b);
    if (!by_a && !by_b) continue;
    const Partials d = partials(graph, id);
    if (by_a) dot[id] += d.a * dot[n.a];
    if (by_b) dot[id] += d.b * dot[n.b];
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
    if (!is_leaf(n) && (moves[n.a] || (is_binary(n.op) && moves[n.b]))) moves[id] = true;
  }
  std::vector<Expression> bar(is_needed.size());
  bar[output] = 1.0;
  for (NodeId id = output + 1; id-- > 0;) {
    const ExpressionNode n = graph[id];
    if (!is_needed[id] || !moves[id] || is_input[id] || is_leaf(n)) continue;
    if (bar[id].is_number() && bar[id].number() == 0.0) continue;
    const Partials d = partials(graph, id);
    if (moves[n.a]) bar[n.a] += bar[id] * d.a;
    if (is_binary(n.op) && moves[n.b]) bar[n.b] += bar[id] * d.b;
  }
  std::vector<NodeId> result;
  for (NodeId input : inputs) result.push_back(bar[input].node());
  return result;
}

std::vector<NodeId> substituted(Graph& graph, std::span<const NodeId> outputs, std::span<const NodeId> inputs,
                                std::span<const NodeId> replacements) {
  const std::vector<bool> is_needed = needed(graph, outputs);
  std::vector<NodeId> now(is_needed.size());
  for (NodeId id = 0; id < is_needed.size(); ++id) now[id] = id;
  for (std::size_t i = 0; i < inputs.size(); ++i) now[inputs[i]] = replacements[i];
  for (NodeId id = 0; id < is_needed.size(); ++id) {
    const ExpressionNode n = graph[id];
    if (!is_needed[id] || is_leaf(n) || now[id] != id) continue;
    if (!is_binary(n.op)) {
      if (now[n.a] != n.a) now[id] = graph.unary(n.op, now[n.a]);
    } else if (now[n.a] != n.a || now[n.b] != n.b) {
      now[id] = graph.binary(n.op, now[n.a], now[n.b]);
    }
  }
  std::vector<NodeId> result;
  for (NodeId output : outputs) result.push_back(now[output]);
  return result;
}

}  // namespace mixloop
