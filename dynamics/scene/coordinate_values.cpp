// SPDX-License-Identifier: MIT
#include "dynamics/scene/coordinate_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "notation/value.hpp"

namespace mixloop {

std::string_view noun_for(std::span<const Scene::Independent> coordinates) {
  return std::ranges::all_of(coordinates, &Scene::Independent::driven) ? "motor" : "coordinate";
}

std::vector<double> read_values(const NodePtr& node, std::span<const Scene::Independent> coordinates,
                                const Quantity& quantity, const char* what) {
  const auto items = items_of(node, what);
  if (items.size() != coordinates.size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected one for each of the {} {}s{}", what,
                                 items.size(), coordinates.size(), noun_for(coordinates),
                                 decimal_commas(items.size(), coordinates.size())));
  std::vector<double> values;
  for (std::size_t i = 0; i < items.size(); ++i)
    values.push_back(number_of(*items[i], quantity.of(coordinates[i]), what));
  return values;
}

}  // namespace mixloop
