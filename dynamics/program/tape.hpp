// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/program/program.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {

/// A program laid out for interpretation. Every value has a slot; instructions of one kind that can follow
/// each other stand together in runs, so that the interpreter chooses once a run and not once an operation.
struct Tape {
  using Slot = std::uint32_t;
  /// What an instruction does: one operation, but for two of which a pair is one instruction.
  struct Kind {
    Op op;                    ///< sin: the cosine, too, whose slot is the next one
    bool of_product = false;  ///< its last operand is a product, whose factors stand in its place
  };
  /// Instructions of a kind: fewer than block_of(kind), or whole blocks.
  struct Run {
    Kind kind;
    std::uint32_t count;
  };
  /// Runs one behind another, whose operands and results go on where those of the run before end.
  struct Part {
    std::vector<Run> runs;
    std::vector<Slot> operands;
    Slot first = 0;  ///< of its results
  };
  struct Load {
    Block block;
    std::uint32_t index;
    Slot slot;
  };

  std::vector<double> values;  ///< the slots; constants filled in
  std::vector<Load> parameters, inputs;
  Part set_up, run;
  std::vector<Slot> outputs;
};

/// Kinds by number, operations of products behind the others.
constexpr std::size_t kKinds = 2 * kOps;
constexpr Tape::Kind kind_at(std::size_t number) { return {static_cast<Op>(number % kOps), number >= kOps}; }
constexpr std::size_t number_of(Tape::Kind kind) {
  return static_cast<std::size_t>(kind.op) + (kind.of_product ? kOps : 0);
}

/// Slots that an instruction takes and gives.
constexpr int operands_of(Tape::Kind kind) { return arity(kind.op) + kind.of_product; }
constexpr int results_of(Tape::Kind kind) { return kind.op == Op::sin ? 2 : 1; }

/// How many instructions are interpreted without a loop, whose end a processor would have to guess: of sines
/// as many as are taken together, of what takes long itself one; none of what is in no tape.
constexpr int block_of(Tape::Kind kind) {
  if (is_leaf(kind.op) || kind.op == Op::hold || kind.op == Op::cos ||
      (kind.of_product && arity(kind.op) < 3))
    return 0;
  return kind.op == Op::sin ? 4 : operation(kind.op).cost > operation(Op::div).cost ? 1 : 8;
}

Tape make_tape(const Program& program);

}  // namespace mixloop
