// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "dynamics/symbolic/operations.hpp"
#include "notation/long_work.hpp"

namespace mixloop {

double apply(Op op, double a, double b, double c) { return mixloop::operation(op).value(a, b, c); }

namespace {

std::uint64_t hash_of(const ExpressionNode& n) {
  std::uint64_t h = static_cast<std::uint64_t>(n.op) * 0x9E3779B97F4A7C15u;
  for (std::uint64_t part : {(std::uint64_t{n.a} << 32) | n.b,
                             std::bit_cast<std::uint64_t>(n.value) ^ (std::uint64_t{n.c} << 32)}) {
    h = (h ^ part) * 0xBF58476D1CE4E5B9u;
    h ^= h >> 29;
  }
  return h;
}

bool are_equal(const ExpressionNode& a, const ExpressionNode& b) {
  return a.op == b.op && a.a == b.a && a.b == b.b && a.c == b.c &&
         std::bit_cast<std::uint64_t>(a.value) == std::bit_cast<std::uint64_t>(b.value);
}

}  // namespace

Graph::Graph(std::size_t most_nodes) : most_nodes_(most_nodes), ids_(1024, kNone) {
  zero_ = constant(0.0);
  one_ = constant(1.0);
}

// Where the node stands among ids_, or would.
std::size_t Graph::place_of(const ExpressionNode& node) const {
  std::size_t place = hash_of(node) & (ids_.size() - 1);
  while (ids_[place] != kNone && !are_equal(nodes_[ids_[place]], node))
    place = (place + 1) & (ids_.size() - 1);
  return place;
}

void Graph::widen() {
  ids_.assign(2 * ids_.size(), kNone);
  for (NodeId id = 0; id < nodes_.size(); ++id) ids_[place_of(nodes_[id])] = id;
}

NodeId Graph::intern(const ExpressionNode& node) {
  work_goes_on();
  NodeId& id = ids_[place_of(node)];
  if (id != kNone) return id;
  if (nodes_.size() == most_nodes_) throw GraphFull();
  const NodeId fresh = id = static_cast<NodeId>(nodes_.size());
  nodes_.push_back(node);
  if (2 * nodes_.size() > ids_.size()) widen();
  return fresh;
}

std::optional<NodeId> Graph::known(const ExpressionNode& node) const {
  const NodeId id = ids_[place_of(node)];
  return id == kNone ? std::nullopt : std::optional(id);
}

NodeId Graph::constant(double value) {
  return intern({.op = Op::constant, .value = value == 0.0 ? 0.0 : value});  // one zero, whatever its sign
}

NodeId Graph::input(Block block, std::size_t index) {
  return intern({Op::input, static_cast<NodeId>(block), static_cast<NodeId>(index)});
}

std::optional<double> Graph::number(NodeId id) const {
  if (nodes_[id].op != Op::constant) return std::nullopt;
  return nodes_[id].value;
}

NodeId Graph::unary(Op op, NodeId a) {
  if (auto x = number(a); x && op != Op::neg) return constant(apply(op, *x));
  switch (op) {
    case Op::neg:
      return neg(a);
    case Op::sin:
      return sine_cosine(a).first;
    case Op::cos:
      return sine_cosine(a).second;
    default:
      break;
  }
  return intern({op, a});
}

NodeId Graph::binary(Op op, NodeId a, NodeId b) {
  auto x = number(a), y = number(b);
  if (x && y) return constant(apply(op, *x, *y));
  switch (op) {
    case Op::add:
      return add(a, b);
    case Op::sub:
      return sub(a, b);
    case Op::mul:
      return mul(a, b);
    case Op::div:
      return div(a, b);
    default:
      break;
  }
  return intern({op, a, b});
}

NodeId Graph::fused(Op op, NodeId a, NodeId b, NodeId c) {
  const auto x = number(a), y = number(b), z = number(c);
  if (x && y && z) return constant(apply(op, *x, *y, *z));
  return intern({op, std::min(a, b), std::max(a, b), c});
}

NodeId Graph::operation(Op op, NodeId a, NodeId b, NodeId c) {
  return arity(op) == 1 ? unary(op, a) : arity(op) == 2 ? binary(op, a, b) : fused(op, a, b, c);
}

NodeId Graph::neg(NodeId a) {
  const ExpressionNode n = nodes_[a];
  if (n.op == Op::constant) return constant(-n.value);
  if (n.op == Op::neg) return n.a;
  if (n.op == Op::sub) return sub(n.b, n.a);
  return intern({Op::neg, a});
}

NodeId Graph::add(NodeId a, NodeId b) {
  if (a == zero_) return b;
  if (b == zero_) return a;
  if (is(b, Op::neg)) return sub(a, nodes_[b].a);
  if (is(a, Op::neg)) return sub(b, nodes_[a].a);
  if (auto one = pythagoras(a, b)) return *one;
  if (number(b)) std::swap(a, b);
  if (auto x = number(a)) {  // c1 + (c2 + y) = (c1 + c2) + y
    const ExpressionNode n = nodes_[b];
    if (auto y = n.op == Op::add ? number(n.a) : std::nullopt) return add(constant(*x + *y), n.b);
    if (auto y = n.op == Op::add ? number(n.b) : std::nullopt) return add(constant(*x + *y), n.a);
    if (auto y = n.op == Op::sub ? number(n.a) : std::nullopt) return sub(constant(*x + *y), n.b);
    if (*x < 0.0)
      if (auto other = known({Op::sub, constant(-*x), b})) return intern({Op::neg, *other});
  }
  if (a == b) return mul(constant(2.0), a);
  return intern({Op::add, std::min(a, b), std::max(a, b)});
}

NodeId Graph::sub(NodeId a, NodeId b) {
  if (a == b) return zero_;
  if (b == zero_) return a;
  if (a == zero_) return neg(b);
  if (is(b, Op::neg)) return add(a, nodes_[b].a);
  if (is(a, Op::neg)) return neg(add(nodes_[a].a, b));
  if (auto y = number(b)) return add(constant(-*y), a);
  if (auto x = number(a)) {  // c1 - (c2 + y), c1 - (c2 - y)
    const ExpressionNode n = nodes_[b];
    if (auto y = n.op == Op::add ? number(n.a) : std::nullopt) return sub(constant(*x - *y), n.b);
    if (auto y = n.op == Op::add ? number(n.b) : std::nullopt) return sub(constant(*x - *y), n.a);
    if (auto y = n.op == Op::sub ? number(n.a) : std::nullopt) return add(constant(*x - *y), n.b);
    // -c - y is the opposite of c + y.
    if (*x < 0.0) return neg(add(constant(-*x), b));
  }
  if (auto other = known({Op::sub, b, a})) return intern({Op::neg, *other});
  return intern({Op::sub, a, b});
}

NodeId Graph::mul(NodeId a, NodeId b) {
  if (a == zero_ || b == zero_) return zero_;
  if (a == one_) return b;
  if (b == one_) return a;
  if (is(a, Op::neg)) return neg(binary(Op::mul, nodes_[a].a, b));
  if (is(b, Op::neg)) return neg(binary(Op::mul, a, nodes_[b].a));
  if (number(b)) std::swap(a, b);
  if (auto x = number(a)) {
    if (*x < 0.0) return neg(mul(constant(-*x), b));  // c y and -c y share one product
    const ExpressionNode n = nodes_[b];
    if (auto y = n.op == Op::mul ? number(n.a) : std::nullopt) return mul(constant(*x * *y), n.b);
    if (auto y = n.op == Op::mul ? number(n.b) : std::nullopt) return mul(constant(*x * *y), n.a);
  }
  return intern({Op::mul, std::min(a, b), std::max(a, b)});
}

NodeId Graph::div(NodeId a, NodeId b) {
  if (a == zero_) return zero_;
  if (b == one_) return a;
  if (is(a, Op::neg)) return neg(div(nodes_[a].a, b));
  if (is(b, Op::neg)) return neg(binary(Op::div, a, nodes_[b].a));
  // A division takes the time of several products; by a constant it is one, at half an ulp.
  if (auto y = number(b); y && std::isnormal(1.0 / *y)) return mul(constant(1.0 / *y), a);
  return intern({Op::div, a, b});
}

// sin(u)^2 + cos(u)^2 = 1
std::optional<NodeId> Graph::pythagoras(NodeId a, NodeId b) {
  auto squared = [&](NodeId id) -> std::optional<NodeId> {
    const ExpressionNode& n = nodes_[id];
    if (n.op != Op::mul || n.a != n.b) return std::nullopt;
    return n.a;
  };
  const auto of_a = squared(a), of_b = squared(b);
  if (!of_a || !of_b) return std::nullopt;
  const ExpressionNode &x = nodes_[*of_a], &y = nodes_[*of_b];
  if (x.op == Op::hold) {
    const auto partner = partners_.find(*of_a);
    if (partner != partners_.end() && partner->second == *of_b) return one_;
  }
  if (x.a != y.a) return std::nullopt;
  if ((x.op == Op::sin && y.op == Op::cos) || (x.op == Op::cos && y.op == Op::sin)) return one_;
  return std::nullopt;
}

std::vector<bool> needed(const Graph& graph, std::span<const NodeId> roots, std::size_t count) {
  std::vector<bool> is_needed(count, false);
  for (NodeId root : roots) is_needed[root] = true;
  for (NodeId id = static_cast<NodeId>(count); id-- > 0;) {
    const ExpressionNode& n = graph[id];
    if (is_needed[id])
      for (NodeId x : Operands(n)) is_needed[x] = true;
  }
  return is_needed;
}

}  // namespace mixloop
