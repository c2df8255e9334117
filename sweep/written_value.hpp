// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mixloop {

/// A number and the unit behind it, as they are written.
struct Measure {
  double number = 0;
  std::string unit;
};
/// Nothing where the text is no finite number, or what stands behind it can be no unit.
std::optional<Measure> measure_in(const std::string& text);

/// Parts at the commas that stand in no brackets.
std::vector<std::string> parts_of(std::string_view text);

}  // namespace mixloop
