// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "dynamics/symbolic/expression.hpp"
#include "dynamics/symbolic/operation_count.hpp"
#include "notation/functions/elementary.hpp"
#include "notation/functions/sincos.hpp"

namespace mixloop {

/// d y / da, / db and / dc of y = op(a, b, c).
using Partials = std::array<Expression, 3>;

/// All that is known of an operation, a row of kOperations.
struct Operation {
  using E = const Expression&;

  Op op;
  std::string_view name;
  int arity;                                      ///< 0: a leaf
  double (*value)(double a, double b, double c);  ///< as every evaluator computes it
  Partials (*partials)(E a, E b, E y);
  double cost;  ///< time in machine code, of an addition; sine and cosine have a half of their pair's
  int latency;  ///< cycles until the result is known, about; those of today's processors differ little
  std::string_view text;  ///< in C++: an operator, or a function; sines and cosines are written in batches
  std::size_t OperationCount::*count;
};

namespace detail {
using E = Operation::E;
using Count = OperationCount;
inline double leaf(double a, double, double) { return a; }
inline Partials none(E, E, E) { return {}; }
}  // namespace detail

/// Costs were measured on several programs.
inline constexpr std::array<Operation, kOps> kOperations = [] {
  using detail::Count, detail::E;
  return std::array<Operation, kOps>{{
      {Op::constant, "constant", 0, detail::leaf, detail::none, 0, 0, "", nullptr},
      {Op::input, "input", 0, detail::leaf, detail::none, 0, 0, "", nullptr},
      {Op::neg, "neg", 1, [](double a, double, double) { return -a; },
       [](E, E, E) {
         return Partials{-1.0, 0.0};
       },
       1, 1, "-", &Count::add},
      {Op::sqrt, "sqrt", 1, [](double a, double, double) { return std::sqrt(a); },
       [](E, E, E y) {
         return Partials{0.5 / y, 0.0};
       },
       5, 18, "mixloop_functions::root", &Count::sqrt},
      {Op::sin, "sin", 1, [](double a, double, double) { return mixloop_functions::sin(a); },
       [](E a, E, E) {
         return Partials{cos(a), 0.0};
       },
       9, 70, "", &Count::sincos},
      {Op::cos, "cos", 1, [](double a, double, double) { return mixloop_functions::cos(a); },
       [](E a, E, E) {
         return Partials{-sin(a), 0.0};
       },
       9, 70, "", &Count::sincos},
      {Op::exp, "exp", 1, [](double a, double, double) { return mixloop_functions::exp(a); },
       [](E, E, E y) {
         return Partials{y, 0.0};
       },
       25, 70, "mixloop_functions::exp", &Count::other},
      {Op::log, "log", 1, [](double a, double, double) { return mixloop_functions::log(a); },
       [](E a, E, E) {
         return Partials{1.0 / a, 0.0};
       },
       25, 70, "mixloop_functions::log", &Count::other},
      {Op::hold, "hold", 1, detail::leaf,
       [](E, E, E) {
         return Partials{1.0, 0.0};
       },
       0, 0, "", nullptr},
      {Op::add, "add", 2, [](double a, double b, double) { return a + b; },
       [](E, E, E) {
         return Partials{1.0, 1.0};
       },
       1, 3, "+", &Count::add},
      {Op::sub, "sub", 2, [](double a, double b, double) { return a - b; },
       [](E, E, E) {
         return Partials{1.0, -1.0};
       },
       1, 3, "-", &Count::add},
      {Op::mul, "mul", 2, [](double a, double b, double) { return a * b; },
       [](E a, E b, E) {
         return Partials{b, a};
       },
       1, 3, "*", &Count::mul},
      {Op::div, "div", 2, [](double a, double b, double) { return a / b; },
       [](E, E b, E y) {
         return Partials{1.0 / b, -y / b};
       },
       5, 14, "/", &Count::div},
      {Op::atan2, "atan2", 2, [](double a, double b, double) { return mixloop_functions::atan2(a, b); },
       [](E a, E b, E) {
         return Partials{b / (a * a + b * b), -a / (a * a + b * b)};
       },
       25, 70, "mixloop_functions::atan2", &Count::other},
      {Op::fma, "fma", 3, [](double a, double b, double c) { return mixloop_functions::fma(a, b, c); },
       [](E a, E b, E) {
         return Partials{b, a, 1.0};
       },
       1, 4, "mixloop_functions::fma", &Count::fused},
      {Op::fms, "fms", 3, [](double a, double b, double c) { return mixloop_functions::fms(a, b, c); },
       [](E a, E b, E) {
         return Partials{b, a, -1.0};
       },
       1, 4, "mixloop_functions::fms", &Count::fused},
      {Op::fnma, "fnma", 3, [](double a, double b, double c) { return mixloop_functions::fnma(a, b, c); },
       [](E a, E b, E) {
         return Partials{-b, -a, 1.0};
       },
       1, 4, "mixloop_functions::fnma", &Count::fused},
  }};
}();

constexpr const Operation& operation(Op op) { return kOperations[static_cast<std::size_t>(op)]; }

static_assert(
    [] {
      for (std::size_t i = 0; i < kOps; ++i) {
        const Op op = static_cast<Op>(i);
        if (operation(op).op != op || operation(op).arity != arity(op)) return false;
      }
      return true;
    }(),
    "a row stands where its Op says");

}  // namespace mixloop
