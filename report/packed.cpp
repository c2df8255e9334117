// SPDX-License-Identifier: MIT
#include "report/packed.hpp"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
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
  std::vector<std::uint32_t> patterns(values.size());
  std::ranges::transform(values, patterns.begin(),
                         [](float value) { return std::bit_cast<std::uint32_t>(value); });
  return packed(patterns);
}

std::string packed(std::span<const std::uint32_t> values) {
  std::vector<unsigned char> planes(4 * values.size());
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t difference = values[i] - before;
    before = values[i];
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
