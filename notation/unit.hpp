// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "notation/dimension.hpp"

namespace mixloop {

/// A unit: what one of it is in SI.
struct Unit {
  double factor;
  Dimension dimension;
};

/// The unit of that name (`cm`, `deg`, `kg`, `Hz`, ...), or nothing.
std::optional<Unit> find_unit(std::string_view name);

/// The names of all units, for messages.
const std::vector<std::string>& unit_names();

}  // namespace mixloop
