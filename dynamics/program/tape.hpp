// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/program/program.hpp"

namespace mixloop {

/// A program laid out for interpretation. Every value has a slot; instructions of one kind that can follow
/// each other stand together in a run, so that the interpreter chooses once a run and not once an
/// operation. A run's results take consecutive slots. A sine and its cosine are one instruction, Op::sin,
/// whose result takes two.
struct Tape {
  using Slot = std::uint32_t;
  struct Run {
    Op op;
    std::uint32_t count;
    Slot first;             ///< slot of its first result
    std::uint32_t operand;  ///< index of its first operand; 1, 2 or 3 an instruction
  };
  struct Load {
    Block block;
    std::uint32_t index;
    Slot slot;
  };

  std::vector<double> values;  ///< the slots; constants filled in
  std::vector<Slot> operands;
  std::vector<Load> parameters, inputs;
  std::vector<Run> set_up, run;
  std::vector<Slot> outputs;
};

Tape make_tape(const Program& program);

}  // namespace mixloop
