// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string_view>

#include "dynamics/symbolic/expression.hpp"
#include "dynamics/symbolic/operation_count.hpp"

namespace mixloop {

/// d y / da and / db of y = op(a, b).
struct Partials {
  Expression a, b;
};

/// All that is known of an operation, a row of kOperations.
struct Operation {
  using E = const Expression&;

  Op op;
  std::string_view name;
  int arity;                            ///< 0: a leaf
  double (*value)(double a, double b);  ///< as every evaluator computes it
  Partials (*partials)(E a, E b, E y);
  double cost;  ///< time in machine code, of an addition; sine and cosine have a half of their pair's
  int latency;  ///< cycles until the result is known, about; those of today's processors differ little
  std::string_view text;  ///< in C++: an operator, or a function; sines and cosines are written in batches
  std::size_t OperationCount::*count;
};

namespace detail {
using E = Operation::E;
using Count = OperationCount;
inline double leaf(double a, double) { return a; }
inline Partials none(E, E, E) { return {0.0, 0.0}; }
}  // namespace detail

/// Costs were measured on several programs.
inline constexpr std::array<Operation, kOps> kOperations = [] {
  using detail::Count, detail::E;
  return std::array<Operation, kOps>{{
      {Op::constant, "constant", 0, detail::leaf, detail::none, 0, 0, "", nullptr},
      {Op::input, "input", 0, detail::leaf, detail::none, 0, 0, "", nullptr},
      {Op::neg, "neg", 1, [](double a, double) { return -a; },
       [](E, E, E) {
         return Partials{-1.0, 0.0};
       },
       1, 1, "-", &Count::add},
      {Op::sqrt, "sqrt", 1, [](double a, double) { return std::sqrt(a); },
       [](E, E, E y) {
         return Partials{0.5 / y, 0.0};
       },
       5, 18, "mixloop_sqrt", &Count::sqrt},
      {Op::sin, "sin", 1, [](double a, double) { return std::sin(a); },
       [](E a, E, E) {
         return Partials{cos(a), 0.0};
       },
       9, 70, "", &Count::sincos},
      {Op::cos, "cos", 1, [](double a, double) { return std::cos(a); },
       [](E a, E, E) {
         return Partials{-sin(a), 0.0};
       },
       9, 70, "", &Count::sincos},
      {Op::exp, "exp", 1, [](double a, double) { return std::exp(a); },
       [](E, E, E y) {
         return Partials{y, 0.0};
       },
       25, 70, "mixloop_exp", &Count::other},
      {Op::log, "log", 1, [](double a, double) { return std::log(a); },
       [](E a, E, E) {
         return Partials{1.0 / a, 0.0};
       },
       25, 70, "mixloop_log", &Count::other},
      {Op::hold, "hold", 1, detail::leaf,
       [](E, E, E) {
         return Partials{1.0, 0.0};
       },
       0, 0, "", nullptr},
      {Op::add, "add", 2, [](double a, double b) { return a + b; },
       [](E, E, E) {
         return Partials{1.0, 1.0};
       },
       1, 4, "+", &Count::add},
      {Op::sub, "sub", 2, [](double a, double b) { return a - b; },
       [](E, E, E) {
         return Partials{1.0, -1.0};
       },
       1, 4, "-", &Count::add},
      {Op::mul, "mul", 2, [](double a, double b) { return a * b; },
       [](E a, E b, E) {
         return Partials{b, a};
       },
       1, 4, "*", &Count::mul},
      {Op::div, "div", 2, [](double a, double b) { return a / b; },
       [](E, E b, E y) {
         return Partials{1.0 / b, -y / b};
       },
       5, 14, "/", &Count::div},
      {Op::atan2, "atan2", 2, [](double a, double b) { return std::atan2(a, b); },
       [](E a, E b, E) {
         return Partials{b / (a * a + b * b), -a / (a * a + b * b)};
       },
       25, 70, "mixloop_atan2", &Count::other},
  }};
}();

constexpr const Operation& operation(Op op) { return kOperations[static_cast<std::size_t>(op)]; }

static_assert(
    [] {
      for (std::size_t i = 0; i < kOps; ++i) {
        const Op op = static_cast<Op>(i);
        if (operation(op).op != op || is_leaf(op) != (operation(op).arity == 0)) return false;
        if (is_binary(op) != (operation(op).arity == 2)) return false;
      }
      return true;
    }(),
    "a row stands where its Op says");

}  // namespace mixloop
