// SPDX-License-Identifier: MIT
#include "report/packed.hpp"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace mixloop {
namespace {

std::string base64(std::span<const unsigned char> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < 3; ++j) word = word << 8 | (i + j < bytes.size() ? bytes[i + j] : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j > bytes.size() ? '=' : kDigits[word >> (18 - 6 * j) & 63];
  }
  return text;
}

}  // namespace

std::string packed(std::span<const float> values) {
  std::vector<unsigned char> planes(4 * values.size());
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(values[i]);
    const std::uint32_t difference = bits - before;
    before = bits;
    for (std::size_t plane = 0; plane < 4; ++plane)
      planes[plane * values.size() + i] = static_cast<unsigned char>(difference >> (8 * plane));
  }
  uLongf size = compressBound(planes.size());
  std::vector<unsigned char> deflated(size);
  if (compress2(deflated.data(), &size, planes.data(), planes.size(), 6) != Z_OK)
    throw std::runtime_error("zlib can't compress");  // only without memory
  return base64({deflated.data(), size});
}

}  // namespace mixloop
