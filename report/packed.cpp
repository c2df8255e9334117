// SPDX-License-Identifier: MIT
#include "report/packed.hpp"

#include <openssl/evp.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace mixloop {
namespace {

std::string base64(std::span<const unsigned char> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                  static_cast<int>(bytes.size()));
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
