// SPDX-License-Identifier: MIT
#include "report/packed.hpp"

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace mixloop {
namespace {

/// As web/shared/unpack.js undoes it.
std::vector<float> unpacked(const std::string& text, std::size_t count) {
  std::vector<unsigned char> deflated(text.size()), planes(4 * count);
  const int size = EVP_DecodeBlock(deflated.data(), reinterpret_cast<const unsigned char*>(text.data()),
                                   static_cast<int>(text.size()));
  if (size < 0) throw std::runtime_error("no base64");
  uLongf length = planes.size();
  // The padding's zeros behind the data are none of zlib's business.
  if (uncompress(planes.data(), &length, deflated.data(), static_cast<uLong>(size)) != Z_OK ||
      length != planes.size())
    throw std::runtime_error("no zlib");
  std::vector<float> values;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t plane = 0; plane < 4; ++plane)
      bits += std::uint32_t{planes[plane * count + i]} << (8 * plane);
    values.push_back(std::bit_cast<float>(bits));
  }
  return values;
}

TEST(Packed, HoldsTheNumbersToTheBitAtEveryLength) {
  std::vector<float> values;
  for (int i = 0; i < 50; ++i) {
    const std::string text = packed(values);
    EXPECT_EQ(text.size() % 4, 0u);
    EXPECT_EQ(unpacked(text, values.size()), values);
    values.push_back(std::sin(0.1F * static_cast<float>(i * i)));
  }
}

}  // namespace
}  // namespace mixloop
