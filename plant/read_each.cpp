// SPDX-License-Identifier: MIT
#include "plant/read_each.hpp"

#include <fmt/format.h>

#include "notation/value.hpp"

namespace mixloop {

std::vector<double> read_each(const NodePtr& node, std::span<const Scene::Independent> coordinates,
                              const Quantity& quantity, const Range& range, const char* what) {
  if (!node) return {};
  const bool one = node->kind == Node::Kind::scalar;
  const auto items = items_of(node, what);
  if (!one && items.size() != coordinates.size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected one for all {}s or one for each of the {}", what,
                                 items.size(), noun_for(coordinates), coordinates.size()));
  std::vector<double> values;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Node& item = *items[one ? 0 : i];
    values.push_back(number_of(item, quantity.of(coordinates[i]), what));
    if (!(values.back() >= range.least && values.back() <= range.most))
      throw InputError("out_of_range", item.place,
                       fmt::format("{} is {:g}; expected {}", what, values.back(), range.expected));
  }
  return values;
}

}  // namespace mixloop
