// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

#include <cmath>

#include "dynamics/program/sincos.hpp"

namespace mixloop {
namespace {

using Slot = Tape::Slot;

template <class Operation>
void each(const Tape::Run& run, double* values, const Slot* operand, Operation operation) {
  constexpr int kOperands = std::is_invocable_v<Operation, double>           ? 1
                            : std::is_invocable_v<Operation, double, double> ? 2
                                                                             : 3;
  double* result = values + run.first;
  for (std::uint32_t k = 0; k < run.count; ++k, operand += kOperands) {
    if constexpr (kOperands == 1) {
      result[k] = operation(values[operand[0]]);
    } else if constexpr (kOperands == 2) {
      result[k] = operation(values[operand[0]], values[operand[1]]);
    } else {
      result[k] = operation(values[operand[0]], values[operand[1]], values[operand[2]]);
    }
  }
}

void run_tape(const std::vector<Tape::Run>& runs, const Slot* operands, double* values) noexcept {
  for (const Tape::Run& run : runs) {
    const Slot* operand = operands + run.operand;
    switch (run.op) {
      case TapeOp::neg:
        each(run, values, operand, [](double a) { return -a; });
        break;
      case TapeOp::sqrt:
        each(run, values, operand, [](double a) { return std::sqrt(a); });
        break;
      case TapeOp::exp:
        each(run, values, operand, [](double a) { return std::exp(a); });
        break;
      case TapeOp::log:
        each(run, values, operand, [](double a) { return std::log(a); });
        break;
      case TapeOp::add:
        each(run, values, operand, [](double a, double b) { return a + b; });
        break;
      case TapeOp::sub:
        each(run, values, operand, [](double a, double b) { return a - b; });
        break;
      case TapeOp::mul:
        each(run, values, operand, [](double a, double b) { return a * b; });
        break;
      case TapeOp::div:
        each(run, values, operand, [](double a, double b) { return a / b; });
        break;
      case TapeOp::atan2:
        each(run, values, operand, [](double a, double b) { return std::atan2(a, b); });
        break;
      case TapeOp::mul_add:
        each(run, values, operand, [](double a, double b, double c) { return a * b + c; });
        break;
      case TapeOp::mul_sub:
        each(run, values, operand, [](double a, double b, double c) { return a * b - c; });
        break;
      case TapeOp::sub_mul:
        each(run, values, operand, [](double a, double b, double c) { return c - a * b; });
        break;
      case TapeOp::sincos:
        for (std::uint32_t k = 0; k < run.count; ++k) {
          double* pair = values + run.first + 2 * k;
          mixloop_sincos::sincos(values[operand[k]], pair, pair + 1);
        }
        break;
    }
  }
}

}  // namespace

void Interpreter::set_up(std::span<const double> parameters) noexcept {
  for (const Tape::Load& load : tape_.parameters) tape_.values[load.slot] = parameters[load.index];
  run_tape(tape_.set_up, tape_.operands.data(), tape_.values.data());
}

void Interpreter::run(const double* psi, const double* psid, const double* input, double t,
                      double* outputs) noexcept {
  double* values = tape_.values.data();
  for (const Tape::Load& load : tape_.inputs) {
    const double* block[] = {psi, psid, input, &t};
    values[load.slot] = block[static_cast<std::size_t>(load.block)][load.index];
  }
  run_tape(tape_.run, tape_.operands.data(), values);
  for (std::size_t k = 0; k < tape_.outputs.size(); ++k) outputs[k] = values[tape_.outputs[k]];
}

}  // namespace mixloop
