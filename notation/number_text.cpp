// SPDX-License-Identifier: MIT
#include "notation/number_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mixloop {

std::string fixed(double value, int digits) {
  return std::abs(value) < 1e9 ? fmt::format("{:.{}f}", value, digits)
                               : fmt::format("{:.{}g}", value, digits);
}

}  // namespace mixloop
