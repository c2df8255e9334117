// SPDX-License-Identifier: MIT
#include "plant/each_motor.hpp"

#include <fmt/format.h>

#include "notation/value.hpp"

namespace mixloop {

std::vector<double> read_each_motor(const NodePtr& node, const Scene& scene, const Dimension& rotary,
                                    const Dimension& linear, const Range& range, const char* what) {
  if (!node) return {};
  const bool one = node->kind == Node::Kind::scalar;
  const auto items = items_of(node, what);
  if (!one && items.size() != scene.motors().size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected one for all motors or one for each of the {}",
                                 what, items.size(), scene.n()));
  std::vector<double> values;
  for (std::size_t i = 0; i < scene.motors().size(); ++i) {
    const Node& item = *items[one ? 0 : i];
    values.push_back(number_of(item, scene.motors()[i].linear ? linear : rotary, what));
    if (!(values.back() >= range.least && values.back() <= range.most))
      throw InputError("out_of_range", item.place,
                       fmt::format("{} is {:g}; expected {}", what, values.back(), range.expected));
  }
  return values;
}

}  // namespace mixloop
