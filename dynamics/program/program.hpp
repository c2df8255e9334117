// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "dynamics/symbolic/graph.hpp"
#include "dynamics/symbolic/operation_count.hpp"

namespace mixloop {

/// A straight-line program: the operations that some outputs need, operands first, and no others.
///
/// What depends on parameters alone stands in the set-up part, which runs when a parameter changes; the
/// evaluation finds its results and costs nothing for them.
struct Program {
  enum class Stage : std::uint8_t { constant, set_up, run };

  std::vector<ExpressionNode> nodes;
  std::vector<Stage> stages;  ///< when each node's value is known
  std::vector<NodeId> outputs;

  OperationCount set_up_operations() const { return operations(Stage::set_up); }
  OperationCount run_operations() const { return operations(Stage::run); }
  /// Set-up values that the run or the outputs use, in order.
  std::vector<NodeId> hoisted() const;
  /// For each sine the cosine of its angle, and the other way round; nodes.size() where there is none.
  std::vector<NodeId> partners() const;

 private:
  OperationCount operations(Stage stage) const;
};

/// Time of an evaluation's machine code in units of an addition, by the costs of operations.hpp.
double estimated_time(const OperationCount& count);

Program make_program(const Graph& graph, std::span<const NodeId> outputs);

/// The program of a program's first outputs: what is left of it has the same operations.
Program first_outputs(const Program& whole, std::size_t count);

}  // namespace mixloop
