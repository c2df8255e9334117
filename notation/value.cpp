// SPDX-License-Identifier: MIT
#include "notation/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "notation/formula.hpp"
#include "notation/look_alikes.hpp"
#include "notation/nearest.hpp"
#include "notation/utf8.hpp"

namespace mixloop {

std::string decimal_commas(std::size_t found, std::size_t expected) {
  return found == 2 * expected ? " (a comma parts values: a number has a decimal point, 0.5)" : "";
}

double number_of(const Node& node, const Dimension& wanted, const std::string& what) {
  static const Scope no_names;
  const Formula formula = parse_formula(node, what, no_names);
  require_dimension(formula, wanted, what);
  return formula.constant();
}

std::vector<double> numbers_of(const NodePtr& node, const Dimension& wanted, std::size_t size,
                               const std::string& what) {
  const auto items = items_of(node, what);
  if (size != 0 && items.size() != size)
    throw InputError("wrong_size", node->place,
                     fmt::format("found {}; expected {}, a list of {}{}", describe(*node), what, size,
                                 decimal_commas(items.size(), size)));
  std::vector<double> values;
  for (const auto& item : items) values.push_back(number_of(*item, wanted, what));
  return values;
}

long whole_number_of(const Node& node, long least, long most, const std::string& what) {
  constexpr double kExact = 9007199254740992.0;  // 2^53: doubles hold every whole number up to here
  const double value = number_of(node, kPure, what);
  const bool whole = value == std::floor(value) && std::abs(value) <= kExact;
  if (!whole || value < static_cast<double>(least) || value > static_cast<double>(most))
    throw InputError("out_of_range", node.place,
                     fmt::format("{} is {}; expected a whole number from {} to {}", what,
                                 in_quotes(node.text), least, most));
  return static_cast<long>(value);
}

std::size_t word_of(const Node& node, const std::vector<std::string>& words, const std::string& what) {
  const std::string& text = text_of(node, what);
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end())
    throw InputError("unknown_value", node.place,
                     what + " is " + in_quotes(text) + suggestion(text, words) + look_alike_in(text));
  return static_cast<std::size_t>(found - words.begin());
}

}  // namespace mixloop
