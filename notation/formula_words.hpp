// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "notation/formula.hpp"

/// What formulas are spelled with.
namespace mixloop {

struct NamedFunction {
  const char* name;
  Formula::Operator op;
  int arguments;
};

/// sin, cos, ..., or null.
const NamedFunction* find_function(std::string_view name);

/// Of ASCII only, whatever the locale.
constexpr bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool goes_on_name(char c) { return starts_name(c) || is_digit(c); }

}  // namespace mixloop
