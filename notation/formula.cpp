// SPDX-License-Identifier: MIT
#include "notation/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>

#include "notation/nearest.hpp"
#include "notation/unit.hpp"

namespace mixloop {
namespace {

using Op = Formula::Operator;

constexpr int kDeepest = 64;
constexpr std::size_t kMostNodes = 4096;

struct NamedFunction {
  const char* name;
  Op op;
  int arguments;
};
constexpr std::array kFunctions = {
    NamedFunction{"sin", Op::kSin, 1},   NamedFunction{"cos", Op::kCos, 1},   NamedFunction{"tan", Op::kTan, 1},
    NamedFunction{"asin", Op::kAsin, 1}, NamedFunction{"acos", Op::kAcos, 1}, NamedFunction{"atan", Op::kAtan, 1},
    NamedFunction{"sqrt", Op::kSqrt, 1}, NamedFunction{"exp", Op::kExp, 1},   NamedFunction{"log", Op::kLog, 1},
    NamedFunction{"atan2", Op::kAtan2, 2}};

const NamedFunction* find_function(std::string_view name) {
  for (const auto& function : kFunctions)
    if (name == function.name) return &function;
  return nullptr;
}

bool starts_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool goes_on_name(char c) { return starts_name(c) || is_digit(c); }

/// Recursive descent: sum > product > sign > power > primary.
class Parser {
 public:
  Parser(std::string_view text, const Place& place, const Scope& scope) : text_(text), place_(place), scope_(scope) {}

  Formula parse() {
    Formula formula = sum();
    skip_space();
    if (at_ < text_.size()) fail("invalid_formula", at_, fmt::format("'{}' where an operator was expected", rest()));
    formula.place = place_;
    return formula;
  }

 private:
  struct Nesting {
    explicit Nesting(Parser& parser) : depth(parser.depth_) {
      if (++depth > kDeepest) parser.fail("invalid_formula", parser.at_, fmt::format("nested deeper than {} levels", kDeepest));
    }
    ~Nesting() { --depth; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;
    int& depth;
  };

  [[noreturn]] void fail(const char* code, std::size_t at, const std::string& message) const {
    Place place = place_;
    if (place.column > 0) place.column += static_cast<int>(at);
    throw InputError(code, place, message + " in '" + (text_.size() > 80 ? std::string(text_.substr(0, 77)) + "..." : std::string(text_)) + "'");
  }
  std::string rest() const { return std::string(text_.substr(at_, 20)); }
  void skip_space() { while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_; }
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
    const Nesting nesting(*this);
    Formula value = product();
    for (;;) {
      skip_space();
      const std::size_t at = at_;
      if (take('+')) value = joined(Op::kAdd, std::move(value), product(), at);
      else if (take('-')) value = joined(Op::kSubtract, std::move(value), product(), at);
      else return value;
    }
  }

  Formula product() {
    Formula value = sign();
    for (;;) {
      skip_space();
      const std::size_t at = at_;
      if (take('*')) value = joined(Op::kMultiply, std::move(value), sign(), at);
      else if (take('/')) value = joined(Op::kDivide, std::move(value), sign(), at);
      else return value;
    }
  }

  Formula sign() {
    const Nesting nesting(*this);
    const std::size_t at = at_;
    if (take('-')) return applied(Op::kNegate, sign(), at);
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
    const Nesting nesting(*this);
    skip_space();
    const std::size_t at = at_;
    if (at_ >= text_.size()) fail("invalid_formula", at, "the end where a value was expected");
    if (take('(')) {
      Formula value = sum();
      if (!take(')')) fail("invalid_formula", at_, "a parenthesis is not closed");
      return value;
    }
    const char c = text_[at_];
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (starts_name(c)) return named();
    if (c == '.' && (rest().starts_with(".nan") || rest().starts_with(".inf") || rest().starts_with(".NaN")))
      fail("not_finite", at, "a number that is not finite");
    fail("invalid_formula", at, fmt::format("'{}' where a value was expected", rest()));
  }

  Formula number() {
    const std::size_t at = at_;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) fail("not_finite", at, "a number too large or too small for a double");
    if (error != std::errc()) fail("invalid_formula", at, fmt::format("'{}' is no number", rest()));
    at_ = static_cast<std::size_t>(end - text_.data());
    Formula result = constant_formula(value, kOpen);
    for (std::string_view name = peek_name(); !name.empty(); name = peek_name()) {
      const std::size_t unit_at = at_;
      const auto unit = find_unit(name);
      if (!unit) fail("unknown_unit", unit_at, fmt::format("unknown unit '{}'{}", name, suggestion(name, unit_names())));
      at_ += name.size();
      result = joined(Op::kMultiply, std::move(result), power_of(constant_formula(unit->factor, unit->dimension)), unit_at);
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
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (lower == "nan" || lower == "inf" || lower == "infinity") fail("not_finite", at, "a number that is not finite");
    fail("undefined_symbol", at, "undefined symbol '" + name + "'" + suggestion(name, scope_.names()));
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
      fail("invalid_formula", at, fmt::format("a formula of more than {} terms", kMostNodes));
    for (Formula::Node node : tail.nodes) {
      if (node.left >= 0) node.left += shift;
      if (node.right >= 0) node.right += shift;
      head.nodes.push_back(node);
    }
    return static_cast<int>(head.nodes.size()) - 1;
  }

  Formula joined(Op op, Formula left, const Formula& right, std::size_t at) const {
    const Dimension dimension = joint_dimension(op, left.dimension, right.dimension, at);
    const bool constant = left.is_constant() && right.is_constant();
    const int left_root = static_cast<int>(left.nodes.size()) - 1;
    const int right_root = append(left, right, at);
    left.nodes.push_back({.op = op, .left = left_root, .right = right_root});
    left.dimension = dimension;
    return constant ? folded(left, at) : left;
  }

  Formula applied(Op op, Formula operand, std::size_t at) const {
    operand.dimension = operand_dimension(op, operand.dimension, at);
    const bool constant = operand.is_constant();
    operand.nodes.push_back({.op = op, .left = static_cast<int>(operand.nodes.size()) - 1});
    return constant ? folded(operand, at) : operand;
  }

  Formula raised(Formula base, int exponent, std::size_t at) const {
    base.dimension = power(base.dimension, exponent);
    const bool constant = base.is_constant();
    base.nodes.push_back({.op = Op::kPower, .left = static_cast<int>(base.nodes.size()) - 1, .exponent = exponent});
    return constant ? folded(base, at) : base;
  }

  Formula folded(const Formula& formula, std::size_t at) const {
    const double value = evaluate<double>(formula, [](int) { return 0.0; });
    if (!std::isfinite(value)) fail("not_finite", at, "a value that is not finite");
    return constant_formula(value, formula.dimension);
  }

  Dimension joint_dimension(Op op, const Dimension& a, const Dimension& b, std::size_t at) const {
    if (op == Op::kMultiply) return a * b;
    if (op == Op::kDivide) return a / b;
    const auto sum = sum_dimension(a, b);
    if (!sum)
      fail("wrong_dimension", at, fmt::format("{} and {} cannot be {}", to_string(a), to_string(b),
                                              op == Op::kAtan2 ? "the two sides of one angle" : "added or subtracted"));
    return op == Op::kAtan2 ? kPure : *sum;
  }

  Dimension operand_dimension(Op op, const Dimension& a, std::size_t at) const {
    if (op == Op::kNegate) return a;
    if (op == Op::kSqrt) {
      if (a.length2 % 2 != 0 || a.mass2 % 2 != 0 || a.time2 % 2 != 0) fail("wrong_dimension", at, "the square root of " + to_string(a));
      return {a.length2 / 2, a.mass2 / 2, a.time2 / 2, a.open};
    }
    if (!a.pure()) fail("wrong_dimension", at, fmt::format("a function of {}; expected a number or an angle", to_string(a)));
    return kPure;
  }

  std::string_view text_;
  Place place_;
  const Scope& scope_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Formula constant_formula(double value, const Dimension& dimension, const Place& place) {
  return {{{.op = Op::kConstant, .value = value}}, dimension, place};
}

void check_name(const std::string& name, const Place& place) {
  const bool well_formed = !name.empty() && starts_name(name[0]) && name.size() <= 64 && std::all_of(name.begin(), name.end(), goes_on_name);
  if (!well_formed)
    throw InputError("invalid_name", place, "'" + name.substr(0, 60) + "' is no name; expected a letter, then letters, digits and _");
  if (find_unit(name)) throw InputError("invalid_name", place, "'" + name + "' is a unit; choose another name");
  if (find_function(name) || name == "pi") throw InputError("invalid_name", place, "'" + name + "' has a meaning in formulas; choose another name");
}

void Scope::define(const std::string& name, Meaning meaning) {
  check_name(name, meaning.place);
  const auto [known, is_new] = meanings_.emplace(name, meaning);
  if (!is_new)
    throw InputError("doubly_defined", meaning.place,
                     "'" + name + "' is defined twice" + (known->second.place.line > 0 ? fmt::format(", first at line {}", known->second.place.line) : ""));
}

void Scope::define_symbol(const std::string& name, int symbol, const Dimension& dimension, const Place& place) {
  define(name, {symbol, {{{.op = Op::kSymbol, .symbol = symbol}}, dimension, place}, place});
}

void Scope::define_formula(const std::string& name, Formula formula, const Place& place) {
  define(name, {-1, std::move(formula), place});
}

const Scope::Meaning* Scope::find(std::string_view name) const {
  const auto found = meanings_.find(name);
  return found == meanings_.end() ? nullptr : &found->second;
}

std::vector<std::string> Scope::names() const {
  std::vector<std::string> all;
  for (const auto& [name, meaning] : meanings_) all.push_back(name);
  return all;
}

Formula parse_formula(std::string_view text, const Place& place, const Scope& scope) { return Parser(text, place, scope).parse(); }

void require_dimension(const Formula& formula, const Dimension& wanted, const std::string& what) {
  if (!fits(formula.dimension, wanted))
    throw InputError("wrong_dimension", formula.place, what + " is " + to_string(formula.dimension) + "; expected " + to_string(wanted));
}

std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < text.size();) {
    if (!starts_name(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && goes_on_name(text[end])) ++end;
    names.emplace_back(text.substr(i, end - i));
    i = end;
  }
  return names;
}

int degree(const Formula& formula, const std::function<bool(int)>& chosen) {
  std::vector<int> degrees;
  degrees.reserve(formula.nodes.size());
  for (const auto& node : formula.nodes) {
    const int left = node.left >= 0 ? degrees[static_cast<std::size_t>(node.left)] : 0;
    const int right = node.right >= 0 ? degrees[static_cast<std::size_t>(node.right)] : 0;
    int result = 2;
    switch (node.op) {
      case Op::kConstant: result = 0; break;
      case Op::kSymbol: result = chosen(node.symbol) ? 1 : 0; break;
      case Op::kAdd:
      case Op::kSubtract: result = std::max(left, right); break;
      case Op::kNegate: result = left; break;
      case Op::kMultiply: result = std::min(2, left + right); break;
      case Op::kDivide: result = right == 0 ? left : 2; break;
      case Op::kPower: result = left == 0 || node.exponent == 0 ? 0 : (node.exponent == 1 ? left : 2); break;
      default: result = left == 0 && right == 0 ? 0 : 2;
    }
    degrees.push_back(result);
  }
  return degrees.back();
}

}  // namespace mixloop
