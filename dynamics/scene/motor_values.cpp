// SPDX-License-Identifier: MIT
#include "dynamics/scene/motor_values.hpp"

#include <fmt/format.h>

#include "notation/value.hpp"

namespace mixloop {

std::vector<double> read_motor_values(const NodePtr& node, const Scene& scene, const Dimension& rotary,
                                      const Dimension& linear, const char* what) {
  const auto items = items_of(node, what);
  if (items.size() != scene.motors().size())
    throw InputError("wrong_size", node->place,
                     fmt::format("{} has {} values; expected one for each of the {} motors", what,
                                 items.size(), scene.n()));
  std::vector<double> values;
  for (std::size_t i = 0; i < items.size(); ++i)
    values.push_back(number_of(*items[i], scene.motors()[i].linear ? linear : rotary, what));
  return values;
}

}  // namespace mixloop
