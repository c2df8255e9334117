// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace mixloop {

/// How an evaluation went.
enum class Status : std::uint8_t { ok, not_finite, not_closed };

namespace detail {
struct StatusRow {
  std::string_view name, sentence;
};
inline constexpr std::array<StatusRow, 3> kStatuses = {{
    {"ok", "the result is finite"},
    {"not_finite",
     "the result is not finite: the mass matrix is singular there, the ends of a spring or damper meet that "
     "needs a direction, or an argument is not finite"},
    {"not_closed",
     "the closures can't be solved there: the mechanism doesn't reach so far, or a singular pose is on the "
     "way"},
}};
}  // namespace detail

/// Its identifier, e.g. "not_finite".
constexpr std::string_view name_of(Status status) {
  return detail::kStatuses[static_cast<std::size_t>(status)].name;
}
/// What it means, for a person.
constexpr std::string_view sentence_of(Status status) {
  return detail::kStatuses[static_cast<std::size_t>(status)].sentence;
}

/// Of an evaluation that gave these.
inline Status status_of(std::span<const double> outputs) noexcept {
  double sum = 0;
  for (const double x : outputs) sum += x - x;  // 0, or not a number
  return sum == 0 ? Status::ok : Status::not_finite;
}

}  // namespace mixloop
