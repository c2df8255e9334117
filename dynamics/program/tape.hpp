// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "dynamics/program/program.hpp"

namespace mixloop {

/// What one instruction of the interpreter computes: the graph's operations by their Op, with a sine and its
/// cosine as one, and a product that only one sum uses as part of that, rounded twice all the same.
enum class TapeOp : std::uint8_t {
  sincos = static_cast<std::uint8_t>(Op::sin),
  times_plus = kOps,  ///< a b + c
  times_minus,        ///< a b - c
  minus_times,        ///< c - a b
};
constexpr std::size_t kTapeOps = kOps + 3;

/// A program laid out for interpretation. Every value has a slot; instructions of one kind that can follow
/// each other stand together in a run, so that the interpreter chooses once a run and not once an
/// operation. A run's results take consecutive slots (a sincos two).
struct Tape {
  using Slot = std::uint32_t;
  struct Run {
    TapeOp op;
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
