// SPDX-License-Identifier: MIT
#include "dynamics/program/short_chains.hpp"

#include <algorithm>
#include <limits>
#include <queue>

#include "dynamics/program/affine_angles.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

// Nodes. Longer programs are interpreted, in runs of like operations, which no chain holds up.
constexpr std::size_t kMostShortened = 200'000;

bool is_sum(Op op) { return op == Op::add || op == Op::sub; }

class Rebuilder {
 public:
  explicit Rebuilder(const Program& program)
      : program_(program),
        uses_(program.nodes.size(), 0),
        divides_(program.nodes.size(), 0),
        values_(program.nodes.size()) {
    find_inner();
  }

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
    NodeId order = 0;      // of equals, the first recorded goes first
    int factors = kNever;  // of a product that a sum may take in: when its factors are known

    bool is_product() const { return factors != kNever; }
    int ready() const { return is_product() ? factors : known; }
    bool operator<(const Value& other) const {
      if (ready() != other.ready()) return ready() > other.ready();
      return is_product() != other.is_product() ? is_product() : order > other.order;
    }
  };
  using Waiting = std::priority_queue<Value>;
  static constexpr int kNever = std::numeric_limits<int>::max();
  static constexpr int kAnglesKnown = 4 * operation(Op::fma).latency;

  // Sums that go into one other sum alone, and products into one other product, are parts of longer ones.
  void find_inner() {
    inner_.assign(program_.nodes.size(), false);
    for (NodeId output : program_.outputs) uses_[output] += 2;
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ExpressionNode& n = program_.nodes[id];
      if (n.op == Op::div && program_.stages[id] == Program::Stage::run) ++divides_[n.b];
      for (NodeId x : Operands(n)) {
        ++uses_[x];
        const Op below = program_.nodes[x].op;
        inner_[x] = program_.stages[x] == program_.stages[id] &&
                    ((is_sum(n.op) && is_sum(below)) || (n.op == Op::mul && below == Op::mul));
      }
    }
    for (NodeId id = 0; id < inner_.size(); ++id) inner_[id] = inner_[id] && uses_[id] == 1;
  }

  // When an operation of this node's stage is known; what is set up before the run is at its beginning.
  int known(NodeId id, int operands, Op op) const {
    return program_.stages[id] == Program::Stage::run ? operands + operation(op).latency : 0;
  }

  Value value(NodeId id) {
    const ExpressionNode& n = program_.nodes[id];
    if (n.op == Op::constant) return {n.value, 0, false, id};
    if (n.op == Op::input) return {Expression::input(static_cast<Block>(n.a), n.b), 0, false, id};
    if (is_sum(n.op) || n.op == Op::mul) return together(id);
    if (n.op == Op::div && (divides_[n.b] > 1 || is_known_before(n.b, id))) return times_reciprocal(id);
    std::array<NodeId, 3> now{};
    int last = 0;
    std::size_t i = 0;
    for (NodeId x : Operands(n)) now[i++] = values_[x].is.node(), last = std::max(last, values_[x].known);
    if (n.op == Op::sin || n.op == Op::cos) {
      if (const auto angle = affine_.at(n.a)) now[0] = written(*angle);
      last = std::max(last, kAnglesKnown);  // they come together
    }
    return {Expression::of(recording_graph().operation(n.op, now[0], now[1], now[2])), known(id, last, n.op),
            false, id};
  }

  // Whether a value is set up before the run that it is used in.
  bool is_known_before(NodeId value, NodeId user) const {
    return program_.stages[value] == Program::Stage::set_up && program_.stages[user] == Program::Stage::run;
  }

  // One product after the other taken in: angles that are written alike are worked out side by side
  // (Statements).
  static NodeId written(const AffineAngle& angle) {
    Graph& graph = recording_graph();
    NodeId sum = graph.constant(angle.constant);
    for (const auto& [index, factor] : angle.terms)
      sum = graph.fused(Op::fma, graph.input(Block::psi, index), graph.constant(factor), sum);
    return sum;
  }

  // Of several divisions by one value one is left, or none in the run: a division takes the time of several
  // products.
  Value times_reciprocal(NodeId id) const {
    const ExpressionNode& n = program_.nodes[id];
    const Value &above = values_[n.a], &below = values_[n.b];
    Value result{above.is * (Expression(1.0) / below.is), 0, false, id};
    const int factors =
        is_known_before(n.b, id) ? above.known : std::max(above.known, known(id, below.known, Op::div));
    result.known = known(id, factors, Op::mul);
    if (uses_[id] == 1) result.factors = factors;
    return result;
  }

  // A whole sum or product, the two that are known first taken together until one is left.
  Value together(NodeId root) {
    Waiting waiting;
    gather(root, waiting);
    const bool is_product = program_.nodes[root].op == Op::mul;
    int factors = 0;
    while (waiting.size() > 1) {
      const Value x = waiting.top();
      waiting.pop();
      const Value y = waiting.top();
      waiting.pop();
      factors = std::max(x.known, y.known);
      waiting.push(is_product
                       ? Value{x.is * y.is, known(root, factors, Op::mul), false, std::max(x.order, y.order)}
                       : sum(root, x, y));
    }
    Value whole = waiting.top();
    if (whole.opposite) whole.is = -whole.is;
    whole.opposite = false;
    if (is_product && uses_[root] == 1) whole.factors = factors;  // others that need it need it whole
    return whole;
  }

  // Of two terms, of which the second is ready last: where it is a product, it is taken in.
  Value sum(NodeId root, Value x, Value y) const {
    if (!y.is_product()) std::swap(x, y);
    Value result{{}, 0, false, std::max(x.order, y.order)};
    if (y.is_product()) {
      const ExpressionNode product = recording_graph()[y.is.node()];
      const Op op = x.opposite == y.opposite ? Op::fma : x.opposite ? Op::fms : Op::fnma;
      result.is = Expression::of(recording_graph().fused(op, product.a, product.b, x.is.node()));
      result.known = known(root, std::max(x.known, y.factors), op);
      result.opposite = x.opposite && y.opposite;
      return result;
    }
    if (x.opposite && !y.opposite) std::swap(x, y);
    const Op op = x.opposite == y.opposite ? Op::add : Op::sub;
    result.is = Expression::binary(op, x.is, y.is);
    result.known = known(root, std::max(x.known, y.known), op);
    result.opposite = x.opposite;
    return result;
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
      waiting.push(part_of(root, id, opposite));
    }
  }

  Value part_of(NodeId root, NodeId id, bool opposite) const {
    Value part = values_[id];
    part.opposite = opposite;
    part.order = id;
    if (is_sum(program_.nodes[root].op) && part.is_product() && !part.is.is_number()) {
      // As it was simplified.
      const ExpressionNode n = recording_graph()[part.is.node()];
      if (n.op == Op::neg) part.is = Expression::of(n.a), part.opposite = !opposite;
      const bool stays = is_known_before(id, root);
      if (!stays && !part.is.is_number() && recording_graph()[part.is.node()].op == Op::mul) return part;
    }
    part.factors = kNever;
    return part;
  }

  const Program& program_;
  const AffineAngles affine_{program_};
  std::vector<int> uses_, divides_;
  std::vector<bool> inner_;
  std::vector<Value> values_;
};

}  // namespace

Program with_short_chains(const Program& program) {
  if (program.nodes.size() > kMostShortened) return program;
  Program rebuilt = Rebuilder(program).rebuilt();
  return estimated_time(rebuilt.run_operations()) <= estimated_time(program.run_operations()) ? rebuilt
                                                                                              : program;
}

}  // namespace mixloop
