// SPDX-License-Identifier: MIT
#include "dynamics/program/short_chains.hpp"

#include <algorithm>
#include <queue>

#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

// Nodes. Longer programs are interpreted, in runs of like operations, which no chain holds up.
constexpr std::size_t kMostShortened = 200'000;

bool is_sum(Op op) { return op == Op::add || op == Op::sub; }

class Rebuilder {
 public:
  explicit Rebuilder(const Program& program)
      : program_(program), inner_(inner()), values_(program.nodes.size()) {}

  Program rebuilt() {
    Graph graph;
    const Recording recording(graph);
    for (NodeId id = 0; id < program_.nodes.size(); ++id)
      if (!inner_[id]) values_[id] = value(id);
    std::vector<NodeId> outputs;
    for (NodeId output : program_.outputs) outputs.push_back(values_[output].is.node());
    return make_program(graph, outputs);
  }

 private:
  // An expression, when it is known, and whether it stands for its opposite.
  struct Value {
    Expression is;
    int known = 0;
    bool opposite = false;
    NodeId order = 0;  // of equals, the first recorded goes first

    bool operator<(const Value& other) const {
      return known != other.known ? known > other.known : order > other.order;
    }
  };
  using Waiting = std::priority_queue<Value>;

  // Sums that go into one other sum alone, and products into one other product: parts of longer ones.
  std::vector<bool> inner() const {
    std::vector<int> uses(program_.nodes.size(), 0);
    std::vector<bool> part(program_.nodes.size(), false);
    for (NodeId output : program_.outputs) uses[output] += 2;
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (is_leaf(n.op)) continue;
      for (NodeId x : operands(n)) {
        ++uses[x];
        const Op below = program_.nodes[x].op;
        part[x] = program_.stages[x] == program_.stages[id] &&
                  ((is_sum(n.op) && is_sum(below)) || (n.op == Op::mul && below == Op::mul));
      }
    }
    for (NodeId id = 0; id < part.size(); ++id) part[id] = part[id] && uses[id] == 1;
    return part;
  }

  static std::vector<NodeId> operands(const ExpressionNode& n) {
    return is_binary(n.op) ? std::vector{n.a, n.b} : std::vector{n.a};
  }

  Value value(NodeId id) {
    const ExpressionNode& n = program_.nodes[id];
    const bool runs = program_.stages[id] == Program::Stage::run;
    if (n.op == Op::constant) return {n.value, 0, false, id};
    if (n.op == Op::input) return {Expression::input(static_cast<Block>(n.a), n.b), 0, false, id};
    if (is_sum(n.op) || n.op == Op::mul) return together(id);
    const Value& a = values_[n.a];
    const int known = runs ? a.known + operation(n.op).latency : 0;
    if (!is_binary(n.op)) return {Expression::unary(n.op, a.is), known, false, id};
    const Value& b = values_[n.b];
    return {Expression::binary(n.op, a.is, b.is),
            runs ? std::max(a.known, b.known) + operation(n.op).latency : 0, false, id};
  }

  // A whole sum or product, the two that are known first taken together until one is left.
  Value together(NodeId root) {
    Waiting waiting;
    gather(root, waiting);
    const bool sum = is_sum(program_.nodes[root].op), runs = program_.stages[root] == Program::Stage::run;
    while (waiting.size() > 1) {
      Value x = waiting.top();
      waiting.pop();
      Value y = waiting.top();
      waiting.pop();
      if (x.opposite && !y.opposite) std::swap(x, y);
      const Op op = !sum ? Op::mul : x.opposite == y.opposite ? Op::add : Op::sub;
      waiting.push({Expression::binary(op, x.is, y.is),
                    runs ? std::max(x.known, y.known) + operation(op).latency : 0, x.opposite,
                    std::max(x.order, y.order)});
    }
    Value whole = waiting.top();
    if (whole.opposite) whole.is = -whole.is;
    whole.opposite = false;
    return whole;
  }

  // The parts of a whole sum or product, from left to right.
  void gather(NodeId root, Waiting& waiting) const {
    std::vector<std::pair<NodeId, bool>> whole{{root, false}};
    while (!whole.empty()) {
      const auto [id, opposite] = whole.back();
      whole.pop_back();
      if (id == root || inner_[id]) {
        const ExpressionNode& n = program_.nodes[id];
        whole.emplace_back(n.b, opposite != (n.op == Op::sub));
        whole.emplace_back(n.a, opposite);
        continue;
      }
      Value part = values_[id];
      part.opposite = opposite;
      part.order = id;
      waiting.push(part);
    }
  }

  const Program& program_;
  std::vector<bool> inner_;
  std::vector<Value> values_;
};

}  // namespace

Program with_short_chains(const Program& program) {
  if (program.nodes.size() > kMostShortened) return program;
  Program rebuilt = Rebuilder(program).rebuilt();
  return rebuilt.run_operations().flops() <= program.run_operations().flops() ? rebuilt : program;
}

}  // namespace mixloop
