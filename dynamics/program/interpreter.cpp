// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "dynamics/program/processor.hpp"
#include "notation/functions/sincos.hpp"

// Handlers are compiled twice: fused operations are calls of the C library's where the processor isn't known
// to have them.
#if defined(__x86_64__)
#define MIXLOOP_WITH_FMA [[gnu::target("fma,avx2")]]
#else
#define MIXLOOP_WITH_FMA
#endif

namespace mixloop {
namespace {

using Slot = Tape::Slot;
using Kind = Tape::Kind;
using Place = Interpreter::Place;
using Handler = Interpreter::Handler;
using Step = Interpreter::Step;

// By one load of both slots: loads are what takes a run's time.
struct Two {
  double first, second;

  [[gnu::always_inline]] Two(const double* values, const Slot* operand) {
    std::uint64_t slots;
    std::memcpy(&slots, operand, sizeof slots);
    first = values[static_cast<Slot>(slots)], second = values[slots >> 32];
    if constexpr (std::endian::native == std::endian::big) std::swap(first, second);
  }
};

template <Kind kind>
[[gnu::always_inline]] inline double result_of(const double* values, const Slot* operand) {
  constexpr auto value = operation(kind.op).value;
  if constexpr (operands_of(kind) == 1) return value(values[*operand], 0.0, 0.0);
  const Two two(values, operand);
  if constexpr (operands_of(kind) == 2) return value(two.first, two.second, 0.0);
  if constexpr (operands_of(kind) == 3) return value(two.first, two.second, values[operand[2]]);
  const Two factors(values, operand + 2);
  return value(two.first, two.second, factors.first * factors.second);
}

template <Kind kind, int count>
[[gnu::always_inline]] inline void interpret(const double* values, const Slot* operand, double* result) {
  if constexpr (kind.op == Op::sin) {
    double angle[count], sine[count], cosine[count];
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) angle[k] = values[operand[k]];
    mixloop_functions::sincos_of(angle, sine, cosine);
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) result[2 * k] = sine[k], result[2 * k + 1] = cosine[k];
  } else {
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) result[k] = result_of<kind>(values, operand + k * operands_of(kind));
  }
}

/// A run of so many instructions, or of so many blocks.
template <Kind kind, int instructions>
MIXLOOP_WITH_FMA Place with_fma(std::uint32_t count, const double* values, const Slot* operand,
                                double* result) {
  do {
    interpret<kind, instructions>(values, operand, result);
    operand += instructions * operands_of(kind), result += instructions * results_of(kind);
  } while (instructions == block_of(kind) && (count -= instructions) > 0);
  return {operand, result};
}

template <Kind kind>
Place plain(std::uint32_t count, const double* values, const Slot* operand, double* result) {
  for (; count > 0; --count, operand += operands_of(kind), result += results_of(kind))
    if constexpr (kind.op == Op::sin)
      mixloop_functions::sincos(values[*operand], result, result + 1);
    else
      *result = result_of<kind>(values, operand);
  return {operand, result};
}

template <Kind kind, int... less>
Handler handler_of(std::uint32_t count, std::integer_sequence<int, less...>) {
  static constexpr Handler kWithFma[] = {&with_fma<kind, less + 1>...};
  return has_fma() ? kWithFma[std::min<std::size_t>(count, sizeof...(less)) - 1] : &plain<kind>;
}

template <std::size_t number>
Handler handler_of(std::uint32_t count) {
  constexpr Kind kind = kind_at(number);
  if constexpr (block_of(kind) == 0)
    return nullptr;
  else
    return handler_of<kind>(count, std::make_integer_sequence<int, block_of(kind)>());
}

template <std::size_t... number>
Handler handler_of(const Tape::Run& run, std::index_sequence<number...>) {
  static constexpr std::array kKind = {&handler_of<number>...};
  return kKind[number_of(run.kind)](run.count);
}

std::vector<Step> steps(const Tape::Part& part) {
  std::vector<Step> steps;
  for (const Tape::Run& run : part.runs)
    steps.push_back({handler_of(run, std::make_index_sequence<kKinds>()), run.count});
  return steps;
}

void run_part(const std::vector<Step>& steps, const Tape::Part& part, double* values) noexcept {
  const Slot* operand = part.operands.data();
  double* result = values + part.first;
  for (const Step& step : steps) {
    const Place next = step.handler(step.count, values, operand, result);
    operand = next.operand, result = next.result;  // stay in registers, which a Place doesn't
  }
}

}  // namespace

Interpreter::Interpreter(const Program& program)
    : tape_(make_tape(program)), set_up_(steps(tape_.set_up)), run_(steps(tape_.run)) {}

void Interpreter::set_up(std::span<const double> parameters, Memory& memory) const noexcept {
  double* values = memory.numbers.data();
  for (const Tape::Load& load : tape_.parameters) values[load.slot] = parameters[load.index];
  run_part(set_up_, tape_.set_up, values);
}

void Interpreter::work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept {
  double* values = memory.numbers.data();
  const double* const blocks[] = {at.psi.data(), at.psid.data(), at.input.data(), &at.t};  // in Block's order
  for (const Tape::Load& load : tape_.inputs)
    values[load.slot] = blocks[static_cast<std::size_t>(load.block)][load.index];
  run_part(run_, tape_.run, values);
  for (std::size_t k = 0; k < tape_.outputs.size(); ++k) outputs[k] = values[tape_.outputs[k]];
}

}  // namespace mixloop
