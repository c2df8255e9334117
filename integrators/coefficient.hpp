// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

namespace mixloop {

/// A method's coefficient as it is printed, a decimal ("-8.298e-3") or a ratio ("-25360/2187"), rounded once
/// in T: the same tables serve double and wider floats.
template <class T>
T coefficient(std::string_view text) {
  const auto slash = text.find('/');
  if (slash != std::string_view::npos)
    return coefficient<T>(text.substr(0, slash)) / coefficient<T>(text.substr(slash + 1));
  if constexpr (std::is_floating_point_v<T>) {
    T value{};
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  } else {
    return T(std::string(text));
  }
}

}  // namespace mixloop
