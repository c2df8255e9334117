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

/// What may be meant by a word that is no unit of ours, a clause for a message: its worth in one of ours
/// where it is known ("; 1 g is 0.001 kg"), else the nearest of ours that is no other power of ten, else all
/// of them.
std::string unit_hint(std::string_view word);

}  // namespace mixloop
