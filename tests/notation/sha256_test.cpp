// SPDX-License-Identifier: MIT
#include "notation/sha256.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string_view>

namespace mixloop {
namespace {

std::string hash_of(std::initializer_list<std::string_view> parts) {
  Sha256 hash;
  for (const auto part : parts) hash.add(std::as_bytes(std::span(part.data(), part.size())));
  return hash.hex();
}

// FIPS 180-4's examples.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(hash_of({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hash_of({"abc"}), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, PartsCountAsOneText) { EXPECT_EQ(hash_of({"a", "", "bc"}), hash_of({"abc"})); }

}  // namespace
}  // namespace mixloop
