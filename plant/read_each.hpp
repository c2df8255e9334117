// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "dynamics/scene/coordinate_values.hpp"

namespace mixloop {

/// Where each value may lie.
struct Range {
  double least, most;
  const char* expected;  ///< in words
};
inline constexpr double kNoLimit = 1e300;

/// One value for all of `coordinates` or a list with one for each. Empty where there is no node. Throws
/// InputError, "out_of_range" at the value that isn't within `range`.
std::vector<double> read_each(const NodePtr& node, std::span<const Scene::Independent> coordinates,
                              const Quantity& quantity, const Range& range, const char* what);

}  // namespace mixloop
