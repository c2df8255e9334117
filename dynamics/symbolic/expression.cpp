// SPDX-License-Identifier: MIT
#include "dynamics/symbolic/expression.hpp"

#include <stdexcept>

namespace mixloop {
namespace {

thread_local Graph* recorded_on = nullptr;

Graph& graph() { return recording_graph(); }

}  // namespace

Graph& recording_graph() {
  if (recorded_on == nullptr) throw std::logic_error("an expression is used while nothing records");
  return *recorded_on;
}

Recording::Recording(Graph& graph) : before_(recorded_on) { recorded_on = &graph; }
Recording::~Recording() { recorded_on = before_; }

Expression Expression::of(NodeId id) {
  if (auto number = graph().number(id)) return *number;
  Expression result;
  result.id_ = id;
  result.is_node_ = true;
  return result;
}

Expression Expression::input(Block block, std::size_t index) { return of(graph().input(block, index)); }

double Expression::number() const {
  if (is_node_) throw std::logic_error("an expression is asked for its number, which depends on the inputs");
  return value_;
}

NodeId Expression::node() const { return is_node_ ? id_ : graph().constant(value_); }

Expression Expression::operator-() const {
  return is_node_ ? of(graph().unary(Op::neg, id_)) : Expression(-value_);
}

Expression Expression::held(const Expression& x, unsigned tag) {
  return x.is_node_ ? of(graph().held(x.node(), tag)) : x;
}

Expression Expression::unary(Op op, const Expression& x) {
  if (!x.is_node_) return apply(op, x.value_);
  return of(graph().unary(op, x.node()));
}

Expression Expression::binary(Op op, const Expression& x, const Expression& y) {
  if (!x.is_node_ && !y.is_node_) return apply(op, x.value_, y.value_);
  return of(graph().binary(op, x.node(), y.node()));
}

}  // namespace mixloop
