// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <numbers>

#include "notation/document.hpp"
#include "notation/formula_words.hpp"
#include "notation/look_alikes.hpp"
#include "notation/nearest.hpp"
#include "notation/unit.hpp"
#include "notation/utf8.hpp"

namespace mixloop {
namespace {

using Op = Formula::Operator;

constexpr int kDeepest = 64;
constexpr int kHighest = 256;
constexpr std::size_t kMostNodes = 4096;
constexpr int kLargestPower = 1000;

constexpr std::array kFunctions = {NamedFunction{"sin", Op::sin, 1},   NamedFunction{"cos", Op::cos, 1},
                                   NamedFunction{"tan", Op::tan, 1},   NamedFunction{"asin", Op::asin, 1},
                                   NamedFunction{"acos", Op::acos, 1}, NamedFunction{"atan", Op::atan, 1},
                                   NamedFunction{"sqrt", Op::sqrt, 1}, NamedFunction{"exp", Op::exp, 1},
                                   NamedFunction{"log", Op::log, 1},   NamedFunction{"atan2", Op::atan2, 2}};

/// nan, inf or infinity, with or without YAML's dot, in any case.
bool is_not_finite(std::string_view word) {
  if (word.starts_with('.')) word.remove_prefix(1);
  std::string lower(word);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

/// Recursive descent: sum > product > sign > power > primary.
class Parser {
 public:
  Parser(const Node& scalar, const Scope& scope) : scalar_(scalar), text_(scalar.text), scope_(scope) {}

  Formula parse() {
    Formula formula = sum();
    skip_space();
    if (at_ < text_.size())
      fail("invalid_formula", at_, fmt::format("found {}; expected an operator{}", rest(), decimal_comma()));
    formula.place = scalar_.place;
    return formula;
  }

 private:
  /// Counted in sign(), which every recursion passes.
  struct Nesting {
    explicit Nesting(Parser& parser) : depth(parser.depth_) {
      if (++depth > kDeepest)
        parser.fail("too_deep", parser.at_, fmt::format("nested deeper than {} levels", kDeepest));
    }
    ~Nesting() { --depth; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    int& depth;
  };

  [[noreturn]] void fail(const char* code, std::size_t at, const std::string& message) const {
    throw InputError(code, place_in(scalar_, at),
                     message + " in " + in_quotes(text_, 80) + look_alike_in(text_));
  }
  std::string decimal_comma() const {
    const bool is_one = text_[at_] == ',' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]);
    return is_one ? " (a number has a decimal point: 0.5, not 0,5)" : "";
  }
  std::string rest() const { return in_quotes(text_.substr(at_), 20); }
  void skip_space() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }
  bool take(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string_view take_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && goes_on_name(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  std::string_view peek_name() {
    skip_space();
    const std::size_t begin = at_;
    if (at_ >= text_.size() || !starts_name(text_[at_])) return {};
    const auto name = take_name();
    at_ = begin;
    return name;
  }

  Formula sum() {
    Formula value = product();
    for (;;) {
      skip_space();
      const std::size_t at = at_;
      if (take('+'))
        value = joined(Op::add, std::move(value), product(), at);
      else if (take('-'))
        value = joined(Op::subtract, std::move(value), product(), at);
      else
        return value;
    }
  }

  Formula product() {
    Formula value = sign();
    for (;;) {
      skip_space();
      const std::size_t at = at_;
      if (take('*'))
        value = joined(Op::multiply, std::move(value), sign(), at);
      else if (take('/'))
        value = joined(Op::divide, std::move(value), sign(), at);
      else
        return value;
    }
  }

  Formula sign() {
    const Nesting nesting(*this);
    const std::size_t at = at_;
    if (take('-')) return applied(Op::negate, sign(), at);
    if (take('+')) return sign();
    return power_of(primary());
  }

  Formula power_of(Formula base) {
    skip_space();
    const std::size_t at = at_;
    if (!take('^')) return base;
    const Formula exponent = sign();
    const double value = exponent.is_constant() ? exponent.constant() : 0.5;
    if (value != std::floor(value) || std::abs(value) > 64)
      fail("invalid_formula", at, "a power that is no whole number up to 64 (sqrt(x) gives the square root)");
    return raised(std::move(base), static_cast<int>(value), at);
  }

  Formula primary() {
    skip_space();
    const std::size_t at = at_;
    if (at_ >= text_.size()) fail("invalid_formula", at, "found the end; expected a value");
    if (take('(')) {
      Formula value = sum();
      if (!take(')')) fail("invalid_formula", at_, "a parenthesis is not closed");
      return value;
    }
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (starts_name(c)) return named();
    if (c == '.' && is_not_finite(text_.substr(at_, 4)))
      fail("not_finite", at, "a number that is not finite");
    fail("invalid_formula", at, fmt::format("found {}; expected a value", rest()));
  }

  Formula number() {
    const std::size_t at = at_;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range)
      fail("not_finite", at, "a number too large or too small for a double");
    if (error != std::errc()) fail("invalid_formula", at, fmt::format("{} is no number", rest()));
    at_ = static_cast<std::size_t>(end - text_.data());
    Formula result = constant_formula(value, kOpen);
    for (std::string_view name = peek_name(); !name.empty(); name = peek_name()) {
      const std::size_t unit_at = at_;
      const auto unit = find_unit(name);
      if (!unit)
        fail("unknown_unit", unit_at, fmt::format("unknown unit {}{}", in_quotes(name), unit_hint(name)));
      at_ += name.size();
      result = joined(Op::multiply, std::move(result),
                      power_of(constant_formula(unit->factor, unit->dimension)), unit_at);
      if (at_ + 1 < text_.size() && text_[at_] == '.' && starts_name(text_[at_ + 1])) ++at_;  // kg.m^2
    }
    return result;
  }

  Formula named() {
    const std::size_t at = at_;
    const std::string name(take_name());
    if (const auto* function = find_function(name)) return call(*function, at);
    if (const auto* meaning = scope_.find(name)) return meaning->formula;
    if (name == "pi") return constant_formula(std::numbers::pi, kPure);
    if (const auto unit = find_unit(name)) return constant_formula(unit->factor, unit->dimension);
    if (is_not_finite(name)) fail("not_finite", at, "a number that is not finite");
    const auto known = scope_.names();
    fail("undefined_symbol", at,
         "undefined symbol " + in_quotes(name) +
             (known.empty() ? "; expected a number" : suggestion(name, known)));
  }

  Formula call(const NamedFunction& function, std::size_t at) {
    if (!take('(')) fail("invalid_formula", at_, fmt::format("{} without its parenthesis", function.name));
    Formula first = sum();
    Formula value;
    if (function.arguments == 2) {
      if (!take(',')) fail("invalid_formula", at_, fmt::format("{} takes two values", function.name));
      value = joined(function.op, std::move(first), sum(), at);
    } else {
      value = applied(function.op, std::move(first), at);
    }
    if (!take(')')) fail("invalid_formula", at_, "a parenthesis is not closed");
    return value;
  }

  /// Appends `tail`'s nodes behind `head`'s; returns the index of tail's root.
  int append(Formula& head, const Formula& tail, std::size_t at) const {
    const int shift = static_cast<int>(head.nodes.size());
    if (head.nodes.size() + tail.nodes.size() >= kMostNodes)
      fail("too_large", at, fmt::format("a formula of more than {} terms", kMostNodes));
    for (Formula::Node node : tail.nodes) {
      if (node.left >= 0) node.left += shift;
      if (node.right >= 0) node.right += shift;
      head.nodes.push_back(node);
    }
    return static_cast<int>(head.nodes.size()) - 1;
  }

  Formula joined(Op op, Formula left, const Formula& right, std::size_t at) const {
    if (op == Op::divide && right.is_zero()) fail("not_finite", at, "a division by zero");
    const Dimension dimension = joint_dimension(op, left.dimension, right.dimension, at);
    const bool constant = left.is_constant() && right.is_constant();
    const int left_root = static_cast<int>(left.nodes.size()) - 1;
    const int right_root = append(left, right, at);
    left.height = std::max(left.height, right.height);
    return rooted(std::move(left), {.op = op, .left = left_root, .right = right_root}, dimension, constant,
                  at);
  }

  Formula applied(Op op, Formula operand, std::size_t at) const {
    const Dimension dimension = operand_dimension(op, operand.dimension, at);
    const bool constant = operand.is_constant();
    const int root = static_cast<int>(operand.nodes.size()) - 1;
    return rooted(std::move(operand), {.op = op, .left = root}, dimension, constant, at);
  }

  Formula raised(Formula base, int exponent, std::size_t at) const {
    const Dimension dimension = power(base.dimension, exponent);
    const bool constant = base.is_constant();
    const int root = static_cast<int>(base.nodes.size()) - 1;
    return rooted(std::move(base), {.op = Op::power, .left = root, .exponent = exponent}, dimension, constant,
                  at);
  }

  /// `operands` under a new root, folded where they are constant.
  Formula rooted(Formula operands, const Formula::Node& root, const Dimension& dimension, bool constant,
                 std::size_t at) const {
    for (const int power2 : {dimension.length2, dimension.mass2, dimension.time2})
      if (std::abs(power2) > kLargestPower)
        fail("wrong_dimension", at, fmt::format("a unit's power past {}", kLargestPower / 2));
    if (++operands.height > kHighest)
      fail("too_large", at, fmt::format("a formula of more than {} levels", kHighest));
    if (operands.nodes.size() >= kMostNodes)
      fail("too_large", at, fmt::format("a formula of more than {} terms", kMostNodes));
    operands.nodes.push_back(root);
    operands.dimension = dimension;
    return constant ? folded(operands, at) : operands;
  }

  Formula folded(const Formula& formula, std::size_t at) const {
    const double value = evaluate<double>(formula, [](int) { return 0.0; });
    if (!std::isfinite(value)) fail("not_finite", at, "a value that is not finite");
    return constant_formula(value, formula.dimension);
  }

  Dimension joint_dimension(Op op, const Dimension& a, const Dimension& b, std::size_t at) const {
    if (op == Op::multiply) return a * b;
    if (op == Op::divide) return a / b;
    const auto sum = sum_dimension(a, b);
    if (!sum)
      fail("wrong_dimension", at,
           fmt::format("{} and {} cannot be {}", to_string(a), to_string(b),
                       op == Op::atan2 ? "the two sides of one angle" : "added or subtracted"));
    return op == Op::atan2 ? kPure : *sum;
  }

  Dimension operand_dimension(Op op, const Dimension& a, std::size_t at) const {
    if (op == Op::negate) return a;
    if (op == Op::sqrt) {
      if (a.length2 % 2 != 0 || a.mass2 % 2 != 0 || a.time2 % 2 != 0)
        fail("wrong_dimension", at, "the square root of " + to_string(a));
      return {a.length2 / 2, a.mass2 / 2, a.time2 / 2, a.open};
    }
    if (!a.pure())
      fail("wrong_dimension", at,
           fmt::format("a function of {}; expected a number or an angle", to_string(a)));
    return kPure;
  }

  const Node& scalar_;
  std::string_view text_;
  const Scope& scope_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

const NamedFunction* find_function(std::string_view name) {
  for (const auto& function : kFunctions)
    if (name == function.name) return &function;
  return nullptr;
}

Formula parse_formula(const Node& scalar, const std::string& what, const Scope& scope) {
  text_of(scalar, what);
  return Parser(scalar, scope).parse();
}

}  // namespace mixloop
