// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>

namespace mixloop {

/// The number of 4 or 8 bytes that stands here as messages and logs have it: highest byte first.
template <std::integral Number>
Number big_endian(const std::uint8_t* at) {
  static_assert(std::endian::native == std::endian::little && (sizeof(Number) == 4 || sizeof(Number) == 8));
  Number number;
  std::memcpy(&number, at, sizeof number);
  if constexpr (sizeof number == 8)
    return static_cast<Number>(__builtin_bswap64(static_cast<std::uint64_t>(number)));
  else
    return static_cast<Number>(__builtin_bswap32(static_cast<std::uint32_t>(number)));
}

}  // namespace mixloop
