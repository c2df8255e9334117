// SPDX-License-Identifier: MIT
#include "notation/formula.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/formula_words.hpp"
#include "notation/unit.hpp"
#include "notation/utf8.hpp"

namespace mixloop {

using Op = Formula::Operator;

Formula constant_formula(double value, const Dimension& dimension, const Place& place) {
  return {{{.op = Op::constant, .value = value}}, dimension, place};
}

void check_name(const std::string& name, const Place& place) {
  const bool well_formed = !name.empty() && starts_name(name[0]) && name.size() <= 64 &&
                           std::all_of(name.begin(), name.end(), goes_on_name);
  if (!well_formed)
    throw InputError(
        "invalid_name", place,
        in_quotes(name) + " is no name; expected a letter, then letters, digits and _, at most 64");
  if (find_unit(name))
    throw InputError("invalid_name", place, "'" + name + "' is a unit; choose another name");
  if (find_function(name) || name == "pi")
    throw InputError("invalid_name", place, "'" + name + "' has a meaning in formulas; choose another name");
}

void Scope::define(const std::string& name, Meaning meaning) {
  check_name(name, meaning.place);
  const Place place = meaning.place;
  const auto [known, is_new] = meanings_.emplace(name, std::move(meaning));
  if (!is_new)
    throw InputError(
        "doubly_defined", place,
        "'" + name + "' is defined twice" +
            (known->second.place.line > 0 ? fmt::format(", first at line {}", known->second.place.line)
                                          : ""));
}

void Scope::define_symbol(const std::string& name, int symbol, const Dimension& dimension,
                          const Place& place) {
  define(name, {symbol, {{{.op = Op::symbol, .symbol = symbol}}, dimension, place}, place});
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

void require_dimension(const Formula& formula, const Dimension& wanted, const std::string& what) {
  if (!fits(formula.dimension, wanted))
    throw InputError("wrong_dimension", formula.place,
                     what + " is " + to_string(formula.dimension) + "; expected " + to_string(wanted));
}

std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  const auto run = [&](std::size_t begin, auto belongs) {
    std::size_t end = begin;
    while (end < text.size() && belongs(text[end])) ++end;
    return end;
  };
  for (std::size_t i = 0; i < text.size();) {
    if (is_digit(text[i]) || text[i] == '.') {  // a number, its exponent: 1.5e3
      i = run(i, [](char c) { return goes_on_name(c) || c == '.'; });
    } else if (starts_name(text[i])) {
      const std::size_t end = run(i, goes_on_name);
      names.emplace_back(text.substr(i, end - i));
      i = end;
    } else {
      ++i;
    }
  }
  return names;
}

int degree(const Formula& formula, const std::function<bool(int)>& chosen) {
  if (formula.nodes.empty()) return 0;
  std::vector<int> degrees;
  degrees.reserve(formula.nodes.size());
  for (const auto& node : formula.nodes) {
    const int left = node.left >= 0 ? degrees[static_cast<std::size_t>(node.left)] : 0;
    const int right = node.right >= 0 ? degrees[static_cast<std::size_t>(node.right)] : 0;
    int result = 2;
    switch (node.op) {
      case Op::constant:
        result = 0;
        break;
      case Op::symbol:
        result = chosen(node.symbol) ? 1 : 0;
        break;
      case Op::add:
      case Op::subtract:
        result = std::max(left, right);
        break;
      case Op::negate:
        result = left;
        break;
      case Op::multiply:
        result = std::min(2, left + right);
        break;
      case Op::divide:
        result = right == 0 ? left : 2;
        break;
      case Op::power:
        result = left == 0 || node.exponent == 0 ? 0 : (node.exponent == 1 ? left : 2);
        break;
      default:
        result = left == 0 && right == 0 ? 0 : 2;
    }
    degrees.push_back(result);
  }
  return degrees.back();
}

}  // namespace mixloop
