// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

#include "dynamics/program/processor.hpp"
#include "dynamics/symbolic/operations.hpp"
#include "notation/functions/sincos.hpp"

// The loops below are compiled twice: fused operations are calls of the C library's where the processor isn't
// known to have them.
#if defined(__x86_64__)
#define MIXLOOP_WITH_FMA [[gnu::target("fma,avx2")]]
#else
#define MIXLOOP_WITH_FMA
#endif

namespace mixloop {
namespace {

using Slot = Tape::Slot;
using Loop = void (*)(const Tape::Run& run, double* values, const Slot* operand);

/// A run of one of the graph's operations.
template <Op op>
[[gnu::always_inline]] inline void run_of(const Tape::Run& run, double* values, const Slot* operand) {
  constexpr int takes = arity(op);
  double* result = values + run.first;
  for (std::uint32_t k = 0; k < run.count; ++k, operand += takes) {
    if constexpr (op == Op::sin)
      mixloop_functions::sincos(values[operand[0]], result + 2 * k, result + 2 * k + 1);
    else
      result[k] = operation(op).value(values[operand[0]], takes > 1 ? values[operand[1]] : 0.0,
                                      takes > 2 ? values[operand[2]] : 0.0);
  }
}

template <Op op>
void plain(const Tape::Run& run, double* values, const Slot* operand) {
  run_of<op>(run, values, operand);
}

template <Op op>
MIXLOOP_WITH_FMA void with_fma(const Tape::Run& run, double* values, const Slot* operand) {
  run_of<op>(run, values, operand);
}

using Loops = std::array<Loop, kOps>;

template <std::size_t... op>
Loops loops_of(std::index_sequence<op...>) {
  return has_fma() ? Loops{&with_fma<static_cast<Op>(op)>...} : Loops{&plain<static_cast<Op>(op)>...};
}

const Loops kLoops = loops_of(std::make_index_sequence<kOps>());

void run_tape(const std::vector<Tape::Run>& runs, const Slot* operands, double* values) noexcept {
  for (const Tape::Run& run : runs)
    kLoops[static_cast<std::size_t>(run.op)](run, values, operands + run.operand);
}

double input(const Arguments& at, const Tape::Load& load) {
  switch (load.block) {
    case Block::psi:
      return at.psi[load.index];
    case Block::psid:
      return at.psid[load.index];
    case Block::input:
      return at.input[load.index];
    default:
      return at.t;
  }
}

}  // namespace

void Interpreter::set_up(std::span<const double> parameters, Memory& memory) const noexcept {
  double* values = memory.numbers.data();
  for (const Tape::Load& load : tape_.parameters) values[load.slot] = parameters[load.index];
  run_tape(tape_.set_up, tape_.operands.data(), values);
}

void Interpreter::work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept {
  double* values = memory.numbers.data();
  for (const Tape::Load& load : tape_.inputs) values[load.slot] = input(at, load);
  run_tape(tape_.run, tape_.operands.data(), values);
  for (std::size_t k = 0; k < tape_.outputs.size(); ++k) outputs[k] = values[tape_.outputs[k]];
}

}  // namespace mixloop
