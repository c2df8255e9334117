// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

#include "dynamics/program/sincos.hpp"
#include "dynamics/symbolic/operations.hpp"

namespace mixloop {
namespace {

using Slot = Tape::Slot;
using Loop = void (*)(const Tape::Run& run, double* values, const Slot* operand);

/// A run of one of the graph's operations.
template <Op op>
void each(const Tape::Run& run, double* values, const Slot* operand) {
  constexpr auto value = operation(op).value;
  double* result = values + run.first;
  for (std::uint32_t k = 0; k < run.count; ++k) {
    if constexpr (op == Op::sin) {
      mixloop_sincos::sincos(values[operand[k]], result + 2 * k, result + 2 * k + 1);
    } else if constexpr (is_binary(op)) {
      result[k] = value(values[operand[2 * k]], values[operand[2 * k + 1]]);
    } else {
      result[k] = value(values[operand[k]], 0.0);
    }
  }
}

template <class Operation>
void each_of_three(const Tape::Run& run, double* values, const Slot* operand) {
  double* result = values + run.first;
  for (std::uint32_t k = 0; k < run.count; ++k, operand += 3)
    result[k] = Operation()(values[operand[0]], values[operand[1]], values[operand[2]]);
}

struct TimesPlus {
  double operator()(double a, double b, double c) const { return a * b + c; }
};
struct TimesMinus {
  double operator()(double a, double b, double c) const { return a * b - c; }
};
struct MinusTimes {
  double operator()(double a, double b, double c) const { return c - a * b; }
};

template <std::size_t... op>
constexpr std::array<Loop, kTapeOps> loops_of(std::index_sequence<op...>) {
  return {&each<static_cast<Op>(op)>..., &each_of_three<TimesPlus>, &each_of_three<TimesMinus>,
          &each_of_three<MinusTimes>};
}
constexpr std::array<Loop, kTapeOps> kLoops = loops_of(std::make_index_sequence<kOps>());

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
