// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace mixloop {

/// Appends numbers as a JSON list; null where one is not finite.
void write_list(fmt::memory_buffer& out, const auto& values) {
  const auto to = std::back_inserter(out);
  const char* between = "";
  out.push_back('[');
  for (const auto value : values) {
    if (std::isfinite(value))
      fmt::format_to(to, "{}{}", between, value);
    else
      fmt::format_to(to, "{}null", between);
    between = ",";
  }
  out.push_back(']');
}

}  // namespace mixloop
