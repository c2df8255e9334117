// SPDX-License-Identifier: MIT
#include "dynamics/program/interpreter.hpp"

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
[[gnu::always_inline]] inline Place run_of(const double* values, const Slot* operand, double* result) {
#pragma GCC unroll 8
  for (int k = 0; k < count; ++k) result[k] = result_of<kind>(values, operand + k * operands_of(kind));
  return {operand + count * operands_of(kind), result + count};
}

template <int count>
[[gnu::always_inline]] inline Place run_of_angles(const double* values, const Slot* operand, double* result) {
  double angle[count], sine[count], cosine[count];
#pragma GCC unroll 4
  for (int k = 0; k < count; ++k) angle[k] = values[operand[k]];
  mixloop_functions::sincos_of(angle, sine, cosine);
#pragma GCC unroll 4
  for (int k = 0; k < count; ++k) result[2 * k] = sine[k], result[2 * k + 1] = cosine[k];
  return {operand + count, result + 2 * count};
}

template <Kind kind, int count>
MIXLOOP_WITH_FMA Place with_fma(const double* values, const Slot* operand, double* result) {
  if constexpr (kind.op == Op::sin)
    return run_of_angles<count>(values, operand, result);
  else
    return run_of<kind, count>(values, operand, result);
}

template <Kind kind, int count>
Place plain(const double* values, const Slot* operand, double* result) {
  if constexpr (kind.op != Op::sin) return run_of<kind, count>(values, operand, result);
  for (int k = 0; k < count; ++k, result += 2)
    mixloop_functions::sincos(values[*operand++], result, result + 1);
  return {operand, result};
}

struct Handlers {
  Handler with_fma, plain;
};

template <Kind kind, int... less>
Handlers of_length(int count, std::integer_sequence<int, less...>) {
  static constexpr Handlers kHandlers[] = {{&with_fma<kind, less + 1>, &plain<kind, less + 1>}...};
  return kHandlers[count - 1];
}

template <std::size_t number>
Handlers of_kind(int count) {
  constexpr Kind kind = kind_at(number);
  if constexpr (longest_run(kind) == 0)
    return {};
  else
    return of_length<kind>(count, std::make_integer_sequence<int, longest_run(kind)>());
}

template <std::size_t... number>
Handlers of_run(const Tape::Run& run, std::index_sequence<number...>) {
  static constexpr std::array kKind = {&of_kind<number>...};
  return kKind[number_of(run.kind)](run.count);
}

std::vector<Handler> handlers(const Tape::Part& part) {
  std::vector<Handler> handlers;
  for (const Tape::Run& run : part.runs) {
    const Handlers found = of_run(run, std::make_index_sequence<kKinds>());
    handlers.push_back(has_fma() ? found.with_fma : found.plain);
  }
  return handlers;
}

void run_part(const std::vector<Handler>& handlers, const Tape::Part& part, double* values) noexcept {
  const Slot* operand = part.operands.data();
  double* result = values + part.first;
  for (const Handler handler : handlers) {
    const Place next = handler(values, operand, result);
    operand = next.operand, result = next.result;  // kept in registers so, as a Place isn't
  }
}

}  // namespace

Interpreter::Interpreter(const Program& program)
    : tape_(make_tape(program)), set_up_(handlers(tape_.set_up)), run_(handlers(tape_.run)) {}

void Interpreter::set_up(std::span<const double> parameters, Memory& memory) const noexcept {
  double* values = memory.numbers.data();
  for (const Tape::Load& load : tape_.parameters) values[load.slot] = parameters[load.index];
  run_part(set_up_, tape_.set_up, values);
}

void Interpreter::work_out(const Arguments& at, Memory& memory, double* outputs) const noexcept {
  double* values = memory.numbers.data();
  const double* const blocks[] = {at.psi.data(), at.psid.data(), at.input.data(),
                                  &at.t};  // as Block has them
  for (const Tape::Load& load : tape_.inputs)
    values[load.slot] = blocks[static_cast<std::size_t>(load.block)][load.index];
  run_part(run_, tape_.run, values);
  for (std::size_t k = 0; k < tape_.outputs.size(); ++k) outputs[k] = values[tape_.outputs[k]];
}

}  // namespace mixloop
