// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "dynamics/scene/scene.hpp"
#include "notation/document.hpp"

namespace mixloop {

/// Where a value of each motor's may lie.
struct Range {
  double least, most;
  const char* expected;  ///< in words
};
inline constexpr double kNoLimit = 1e300;

/// One value for all motors or a list with one for each, of the dimension `rotary` or `linear` as the motor
/// is. Empty where there is no node. Throws InputError, "out_of_range" at the value that isn't within
/// `range`.
std::vector<double> read_each_motor(const NodePtr& node, const Scene& scene, const Dimension& rotary,
                                    const Dimension& linear, const Range& range, const char* what);

}  // namespace mixloop
